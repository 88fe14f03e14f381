// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "lab/synth/render.h"
#include "telemime/core/camera.h"

namespace telemime {

/// A simple camera sensor.
struct Sensor {
  double noise = 2.0;  ///< standard deviation, grey levels of 0..255, each channel of each pixel on its own
  double flicker = 0.004;  ///< standard deviation of the gain from frame to frame
};

/// A scene to render. The same options give the same pixels for any number of threads.
struct SceneOptions {
  Gesture gesture = Gesture::asking;
  int width = 640;
  int height = 480;
  double field_of_view = 60.0;  ///< horizontal, degrees
  std::uint64_t seed = 1;       ///< draws the person, the background, the manner of the gesture and the noise
  int frames = kGestureFrames;  ///< a longer clip repeats the gesture
  Sensor sensor;
  bool light_change = false;  ///< a warm lamp comes on within three frames at the middle of the clip
  bool long_sleeves = false;
  bool striped_shirt = false;
  double distance = 0.0;      ///< of the person from the camera, m; 0: as the gesture is staged, about 1.4
  double camera_pitch = 0.0;  ///< rad; + the camera looks up: in its frame, the person leans back
  double turn = 0.0;          ///< rad; + the person sits turned to their left, the face to the camera
  /// Folder of the meshes of people (read_mesh_person); empty: the person is drawn from smooth solids.
  std::filesystem::path people;
  /// The scene is empty at first; the person enters from the side, gestures, leaves, and the scene is empty
  /// again.
  bool walk_in = false;
  bool fingers = false;  ///< each finger bends and stretches in its own time; the truth has them
  double look_around =
      0.0;  ///< rad; the head turns by it to either side and nods by 15 degrees; 0: it does not
};

/// The person, the background and the camera, ready to be rendered; a constant value.
struct Scene {
  SceneOptions options;
  Camera camera;
  Look look;
  Backdrop backdrop;
  std::shared_ptr<const MeshPerson> mesh;  ///< nullptr: the drawn person, `look`
};

/// Throws Error(usage) for an image under 16 x 12 or over 4096 x 4096 pixels, fewer than 1 frame (fewer than
/// 120 with walk_in), negative noise, a distance outside 0.6 to 1.8 m, a pitch beyond 30 or a turn beyond 90
/// degrees, or stripes on people of meshes. Throws Error(input) for people that cannot be read.
Scene make_scene(const SceneOptions& options);

/// Whether the neck of the person is inside the image at a frame (0-based).
bool person_is_visible(const Scene& scene, int frame);

/// The bones of the actor at a frame (0-based), camera frame, m.
ActorKinematics scene_kinematics(const Scene& scene, int frame);

/// Where the joints of the person in the picture are at a frame (0-based), camera frame, m: those of the
/// actor, or of the meshes, whose bones have the actor's directions.
PersonTruth scene_truth(const Scene& scene, int frame);

/// One frame as the camera would give it, with what each pixel shows and the true joints.
struct SynthFrame {
  cv::Mat image;          ///< (height x width) CV_8UC3, BGR
  cv::Mat surfaces;       ///< (height x width) CV_8UC1, Surface
  JointPositions joints;  ///< camera frame, m
};
SynthFrame render_frame(const Scene& scene, int frame);

/// A frame of the same scene without the person; `index` only changes noise and flicker.
cv::Mat render_background(const Scene& scene, int index);

/// The true joints of all frames as JSON: intrinsics, joint names, positions in mm, bone lengths of frame 0,
/// and, with walk_in, the frames in which the person is visible.
std::string truth_json(const Scene& scene);

struct SequenceOptions {
  SceneOptions scene;
  std::filesystem::path folder;  ///< DIR; the files go to DIR/<gesture>/
  int background_frames = 40;    ///< 0: no background clip
  /// video.mp4 and background.mp4 (H.264 at rate factor 23, the only one that OpenCV 4.6 can write; it wipes
  /// out most of the noise) instead of lossless video.mkv and background.mkv (FFV1).
  bool compact = false;
  bool small_videos = true;  ///< also video_160x120.mkv and background_160x120.mkv, always lossless;
                             ///< not for images that are no larger
  int threads = 0;           ///< 0: all cores, which is also the most
  /// Called on the calling thread after each frame with (frames done, frames in all); may be empty.
  std::function<void(int, int)> progress;
};

/// The last file of a sequence that is written: where it exists, the sequence is complete.
inline constexpr const char* kPreview = "preview.png";

struct SequenceFiles {
  std::filesystem::path video;
  std::vector<std::filesystem::path> all;
};

/// Renders the gesture and writes video, background, their 160-pixel-wide copies, truth.json and preview.png.
/// Clips of an earlier run in its folder are removed first.
/// A compact clip of odd size, or where OpenCV can write neither H.264 nor MPEG-4, is lossless all the same.
/// Throws Error(output) that names the file which could not be written.
SequenceFiles make_sequence(const SequenceOptions& options);

}  // namespace telemime
