// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "telemime/core/frame.h"
#include "telemime/image/face_memory.h"
#include "telemime/image/feature_config.h"
#include "telemime/image/frame_features.h"
#include "telemime/image/head_shape.h"
#include "telemime/image/head_tracker.h"
#include "telemime/image/scene_bootstrap.h"

namespace telemime {

/// Frame -> FrameFeatures (thesis 2.4.4.1, 3.4, 3.5.1). Holds what it has learned of the scene and the
/// person; the same frames in the same order always give the same features.
///
///     FeatureExtractor features(config);
///     features.learn_background(empty_frames);      // or features.bootstrap(clip)
///     while (!features.learn_person(frame).accepted) frame = next();
///     FrameFeatures seen = features.extract(frame);   // this and every later frame
class FeatureExtractor {
 public:
  /// Throws Error(config) for a bad configuration or missing face cascades.
  explicit FeatureExtractor(const ImageConfig& config);

  /// Learns the scene from frames without a person. Throws Error(usage) when there is none.
  void learn_background(std::span<const Frame> frames);

  /// Learns what it can of the scene from frames of the clip itself (all of it, or the first second of a live
  /// input; one frame is enough): an empty stretch, else around the person, else colours alone. At most 150
  /// frames are looked at for an empty stretch, 16 spread over the clip for the rest.
  SceneReport bootstrap(std::span<const Frame> clip);

  /// Learns skin, clothes and hair from a frame in which the face is seen. Refuses with a reason; then try
  /// the next frame. Frames may be extracted before a person has begun: their labels are background and
  /// ignore.
  PersonReport learn_person(const Frame& frame);

  /// Everything of one frame. Frames in the order of time.
  FrameFeatures extract(const Frame& frame);

  const ImageStatus& status() const { return status_; }
  const ImageCalibration& calibration() const { return calibration_; }
  void set_calibration(ImageCalibration calibration);
  const ImageConfig& config() const { return config_; }

 private:
  struct Pictures {
    cv::Mat bgr;       ///< of the working size
    cv::Mat grey;      ///< of the working size
    cv::Mat face;      ///< grey, for the face detector
    LogColour colour;  ///< of the working size
  };
  Pictures pictures_of(const Frame& frame) const;
  std::optional<HeadRegion> region_of(const std::optional<TrackedFace>& face, const Pictures& p) const;
  BackgroundEnergy background_of(Pictures& pictures, const std::optional<HeadRegion>& head);
  bool stands_out(const BackgroundEnergy& background, const HeadRegion& head) const;
  cv::Rect search_area(const Pictures& p) const;
  FaceTest face_test(const Pictures& p) const;
  void follow_outline(const Pictures& p, const cv::Mat& silhouette);
  std::vector<SceneSample> samples_of(std::span<const Frame> clip);
  double all_valid_share() const;
  void watch_camera(const cv::Mat& grey);
  void update_status(const Pictures& p, const FrameFeatures& seen);

  ImageConfig config_;
  HeadTracker head_;
  HeadShape shape_;
  FaceMemory face_memory_;
  ImageCalibration calibration_;
  ImageStatus status_;
  bool all_valid_ = true;  ///< the background of every pixel was seen
  cv::Mat believed_;       ///< background of the frame before
  cv::Mat silhouette_;     ///< of the frame before
  cv::Mat motion_grey_;    ///< picture of the last look at the camera's motion
  cv::Mat motion_scene_;   ///< what was background at that look
  int since_motion_ = 0;
  int hollow_ = 0;  ///< frames in a row in which the head had neither skin nor hair
};

}  // namespace telemime
