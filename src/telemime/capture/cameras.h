// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace telemime {

/// A format, size and rate in which a camera delivers images.
struct CameraMode {
  std::string format;  ///< V4L2's four characters: "YUYV", "MJPG", ...
  int width = 0;       ///< pixels
  int height = 0;
  double fps = 0.0;  ///< the highest rate of this format and size, frames per second; 0: not known

  bool operator==(const CameraMode&) const = default;
};

/// What a device under /dev/video* delivers.
enum class CameraKind {
  camera,     ///< images
  metadata,   ///< descriptions of the images of another device of the same camera, no images
  no_camera,  ///< something else: an output, a codec, a radio
  unknown,    ///< it could not be asked (CameraInfo::problem)
};

/// A device for video.
struct CameraInfo {
  std::string device;      ///< "/dev/video0"
  std::string name = {};   ///< as the driver says: "HD Pro Webcam C920"
  std::string by_id = {};  ///< "/dev/v4l/by-id/usb-046d_...", the same whatever port it is at; may be empty
  CameraKind kind = CameraKind::unknown;
  std::vector<CameraMode> modes = {};  ///< of a camera
  std::string problem = {};            ///< why it cannot be asked or used: no permission, in use
};

/// Asks a device for its kind, problem and modes.
using AskCamera = std::function<void(CameraInfo&)>;

/// Asks by V4L2 and closes the device again, without starting it.
void ask_v4l2(CameraInfo& camera);

/// All devices for video, in the order of their numbers. `root` is "/" except in tests.
std::vector<CameraInfo> list_cameras(const std::filesystem::path& root = "/",
                                     const AskCamera& ask = ask_v4l2);

/// The mode to track with: at least 25 frames a second if any has them, then nearest to 640 x 480, then not
/// compressed. Raw images that come too slowly (YUYV of many cameras, through USB 2) so give way to Motion
/// JPEG. Nothing where no mode has a format that can be decoded.
std::optional<CameraMode> best_mode(const std::vector<CameraMode>& modes);

/// Whether the camera has a format with colours; infrared cameras have none.
bool has_colour(const CameraInfo& camera);

/// The device of the camera that `text` names: by its number, by its device or by a part of its name or of
/// its by_id, whatever the case of the letters. Without text, the first camera with colours, else the first.
/// Nothing where no camera is meant. Throws Error(usage) when several cameras of different names are meant,
/// with a list of them.
std::optional<std::string> find_camera(const std::vector<CameraInfo>& cameras, const std::string& text);

/// The input with the name of a camera replaced by its device: "c920" becomes "/dev/video2" where there is no
/// file of that name. An empty input becomes the camera that find_camera() gives without text, or "0".
/// `list` is called only where a camera may be meant, because it opens all of them. Throws as find_camera().
std::string with_camera_found(const std::string& input, const std::function<std::vector<CameraInfo>()>& list);

/// Why this device gives no images and which one does instead, for messages; empty where it is a camera.
std::string why_no_images(const std::vector<CameraInfo>& cameras, const std::string& device);

/// The cameras for messages: "/dev/video0 (HD Webcam), /dev/video2 (C920)"; empty when there is none.
std::string in_words(const std::vector<CameraInfo>& cameras);

}  // namespace telemime
