// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "telemime/core/frame.h"
#include "telemime/image/background_model.h"
#include "telemime/image/head_shape.h"
#include "telemime/image/head_tracker.h"
#include "telemime/image/observation.h"
#include "telemime/image/person_colours.h"
#include "telemime/image/segmentation.h"

namespace telemime {

struct EdgeConfig {
  double alpha = 1.2;          ///< of the Deriche filter, at any working size
  double low = 3.0;            ///< grey levels per pixel
  double high = 8.0;           ///< grey levels per pixel
  double distance_cap = 10.0;  ///< pixels at 160x120; grows with the working width
};

struct ImageConfig {
  int width = 160;                 ///< of the working image, pixels
  int height = 120;                ///< pixels
  std::filesystem::path cascades;  ///< folder of OpenCV's face cascades; empty: searched
  int face_width = 320;            ///< the face detector looks at pictures of at most this width
  HeadTrackerConfig head;
  double head_shape_rate = 0.2;  ///< share of each frame in the head's outline
  ShadowRange shadow;
  SegmentationConfig segmentation;
  EdgeConfig edges;
  float background_rate = 0.01F;  ///< share of each frame that uncovered background takes over
  /// Throws Error(config) that names the value and its range.
  void validate() const;
};

/// What calibration learned; a value that can be saved (calibration_file.h).
struct ImageCalibration {
  BackgroundModel background;
  PersonColours colours;
};

/// Frame -> Observation (thesis 2.4.4.1, 3.4, 3.5.1). Holds what it has learned of the scene and the person;
/// the same frames in the same order always give the same observations.
class FeatureExtractor {
 public:
  /// Throws Error(config) for a bad configuration or missing face cascades.
  explicit FeatureExtractor(const ImageConfig& config);

  /// Learns the scene from frames without a person. Throws Error(usage) when there is none.
  void learn_background(std::span<const Frame> frames);

  /// Learns skin, clothes and hair from a frame in which the face is seen. Refuses with a reason.
  PersonReport begin_person(const Frame& frame);

  /// Everything of one frame. Frames in the order of time.
  Observation extract(const Frame& frame);

  const ImageCalibration& calibration() const { return calibration_; }
  void set_calibration(ImageCalibration calibration);
  const ImageConfig& config() const { return config_; }

 private:
  struct Pictures;
  Pictures pictures_of(const Frame& frame) const;
  std::optional<HeadRegion> region_of(const std::optional<TrackedFace>& face, const Pictures& p) const;
  BackgroundEnergy background_of(Pictures& pictures);

  ImageConfig config_;
  HeadTracker head_;
  HeadShape shape_;
  ImageCalibration calibration_;
  cv::Mat believed_;  ///< background of the frame before
};

}  // namespace telemime
