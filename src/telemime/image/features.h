// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>

#include "telemime/core/frame.h"
#include "telemime/image/camera_motion.h"
#include "telemime/image/deriche.h"
#include "telemime/image/face_memory.h"
#include "telemime/image/feature_config.h"
#include "telemime/image/frame_features.h"
#include "telemime/image/head_shape.h"
#include "telemime/image/head_tracker.h"
#include "telemime/image/image_calibration.h"
#include "telemime/image/image_status.h"
#include "telemime/image/person_finder.h"
#include "telemime/image/scene_bootstrap.h"

namespace telemime {

/// Turns a Frame into FrameFeatures (thesis 2.4.4.1, 3.4, 3.5.1). Holds the models of the scene and the
/// person. The same frames in the same order always give the same features.
///
///     FeatureExtractor extractor(config);
///     extractor.learn_background(empty_frames);  // or extractor.bootstrap(clip)
///     while (!extractor.learn_person(frame).accepted) frame = next();
///     FrameFeatures features = extractor.extract(frame);  // this frame and all later ones
class FeatureExtractor {
 public:
  /// Throws Error(config) for an invalid configuration or missing face cascades.
  explicit FeatureExtractor(const ImageConfig& config);

  /// Whether networks find the person: then the background need not be learned beforehand.
  bool has_networks() const { return finder_.has_networks(); }

  /// Learns the background model from frames without a person. Throws Error(usage) if `frames` is empty.
  void learn_background(std::span<const Frame> frames);

  /// Learns the background from the clip to be tracked: all frames of a file or the first second of a live
  /// input; one frame is enough. Uses an empty stretch of the clip if there is one, otherwise the area around
  /// the person, and only colours if the camera moves. At most 150 frames are searched for an empty stretch;
  /// 20 frames spread over the clip serve for the rest. Gives a sentence for the user that says how it was
  /// learned, or why it was not. Throws Error(usage) if `clip` is empty.
  std::string bootstrap(std::span<const Frame> clip);

  /// Learns the colours of skin, clothes and hair from a frame in which the face is visible. If the frame is
  /// not suitable, the report gives the reason; try the next frame. Until a person has been learned,
  /// extract() labels the person `ignore` outside the head.
  PersonReport learn_person(const Frame& frame);

  /// The landmarks that networks see of the person in a frame, in pixels of the working image, without the
  /// mask; they look at a frame once, whichever function asks first. Empty without networks or if nobody is
  /// found. Throws as extract().
  std::optional<PoseLandmarks> find_landmarks(const Frame& frame);

  /// The part of extract() that needs no network, so that it can run beside find_landmarks() of the same
  /// frame. extract() of the frame with this index then starts from what it computed; the features are the
  /// same without it. Another background or person, learned or set, discards it. Throws as extract().
  void prepare(const Frame& frame);

  /// The features of one frame. Call it in temporal order: the models adapt to each frame. Throws
  /// Error(input) if the frame has no 8-bit BGR image.
  FrameFeatures extract(const Frame& frame);

  /// How well the assumptions held in the last extracted frame, with warnings for the user.
  const ImageStatus& status() const { return status_; }
  const ImageCalibration& calibration() const { return calibration_; }
  /// Replaces the models of scene and person. Throws Error(config) if the background has another working
  /// size.
  void set_calibration(ImageCalibration calibration);
  const ImageConfig& config() const { return config_; }
  cv::Size working_size() const { return {config_.width, config_.height}; }

 private:
  /// An image in the light in which the background was learned.
  struct LitImage {
    LogColour colour;
    double change = 0.0;  ///< ln of how much brighter the image was than in that light
  };
  /// How well the scene explains the colours of an image, the person apart.
  struct SceneEnergies {
    BackgroundEnergy background;  ///< empty without a background
    cv::Mat surroundings;         ///< of pixels whose background is unknown; empty if there are none
  };
  struct CameraCheck {
    std::optional<SharedMotion> shared;  ///< since the image of the last check; empty if nobody can tell
  };
  struct WorkingImages {
    cv::Mat bgr;       ///< working size
    cv::Mat grey;      ///< working size
    cv::Mat face;      ///< grey, at the size of the face detector
    LogColour colour;  ///< working size; that of `lit` once it was compared with the background
    std::optional<LitImage> lit;
    Gradient gradient;  ///< of `grey`; empty where only working_images() was called
    // Empty where they were not prepared:
    std::optional<SceneEnergies> scene;    ///< of `colour`
    std::optional<ColourEnergies> person;  ///< of `colour`
    std::optional<CameraCheck> camera;
  };
  WorkingImages working_images(const Frame& frame) const;
  LitImage in_light_of_background(const LogColour& colour, const cv::Mat& background) const;
  SceneEnergies compare_with_scene(const LogColour& colour) const;
  std::optional<HeadRegion> head_region_of(const std::optional<TrackedFace>& face,
                                           const WorkingImages& p) const;
  BackgroundEnergy background_energy_of(WorkingImages& images, const std::optional<HeadRegion>& head,
                                        const cv::Mat& mask = {});
  /// find_landmarks() with the mask. Where colours are known, it may be that of a picture up to 45 ms before,
  /// unless it must be this frame's own.
  std::optional<PoseLandmarks> find_person(const Frame& frame, bool own_mask = false);
  std::optional<TrackedFace> face_of(const std::optional<PoseLandmarks>& landmarks, const WorkingImages& p);
  bool differs_from_background(const BackgroundEnergy& background, const HeadRegion& head) const;
  cv::Rect face_search_area(const WorkingImages& p) const;
  FaceTest skin_test(const WorkingImages& p) const;
  void follow_head_outline(const WorkingImages& p, const cv::Mat& silhouette);
  std::vector<SceneSample> scene_samples(std::span<const Frame> clip);
  double known_background_share() const;
  PersonReport learn_person_in(const Frame& frame);
  double over_elapsed(double rate) const;
  void update_background(const WorkingImages& p, const BackgroundEnergy& background,
                         const std::optional<PoseLandmarks>& landmarks);
  double elapsed_until(double time) const;
  bool camera_check_is_due(double elapsed) const;
  CameraCheck check_camera(const cv::Mat& grey) const;
  void update_camera_motion(const WorkingImages& p);
  void update_status(const WorkingImages& p, const FrameFeatures& features);

  double networks_ms_ = 0.0;  ///< time of the networks in the last frame that they looked at

  ImageConfig config_;
  PersonFinder finder_;
  std::int64_t prepared_in_ = -1;  ///< index of the frame that `prepared_` shows; -1: none
  WorkingImages prepared_;
  std::int64_t found_in_ = -1;          ///< index of the frame in which `found_` was found
  std::optional<PoseLandmarks> found_;  ///< in pixels of the working image
  HeadTracker head_;
  HeadShape shape_;
  FaceMemory face_memory_;
  ImageCalibration calibration_;
  ImageStatus status_;
  bool seen_ = false;                ///< a frame was extracted
  bool background_complete_ = true;  ///< the background is known at every pixel
  cv::Mat background_mask_;          ///< 255 on the background of the previous frame
  cv::Mat silhouette_;               ///< of the previous frame
  cv::Mat motion_image_;             ///< image of the last camera motion check
  cv::Mat motion_mask_;              ///< background mask of that image
  double since_motion_ = 0.0;        ///< 1/25 s
  std::optional<double> last_time_;  ///< of the last frame, s
  double elapsed_ = 1.0;             ///< between the last two frames, 1/25 s
  double camera_step_ = 0.0;         ///< motion of the camera in the last check, in the unit of ImageStatus
  /// 1/25 s since the first of the frames whose head region has little skin or hair, or that have no colour;
  /// empty while the last one is not such a frame.
  std::optional<double> without_skin_, grey_for_;
};

}  // namespace telemime
