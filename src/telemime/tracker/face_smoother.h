// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "telemime/body/face_motion.h"
#include "telemime/tracker/one_euro.h"

namespace telemime {

/// Steadies a face by One-Euro filters: eyelids, jaw and lips follow at once, brows and head steadily. A face
/// that is not seen goes to rest within about half a second, and its confidence to 0; then there is none.
class FaceSmoother {
 public:
  /// `time` in s. A time that does not advance, or that advances more than kLongestGap, begins a new motion.
  std::optional<FaceMotion> operator()(const std::optional<FaceMotion>& measured, double time);

 private:
  void follow(const FaceMotion& measured, double step);
  void learn_noise(const FaceMotion& measured, double step);
  /// The likeliest face behind what was steadied: the noisier, the nearer to rest.
  std::optional<FaceMotion> likely() const;

  std::optional<double> time_;
  std::optional<FaceMotion> smooth_;
  std::optional<FaceMotion> last_;  ///< measured in the last frame, if seen
  std::array<SpeedShare, kExpressionCount> speed_;
  SpeedShare head_speed_;
  SpeedShare gaze_speed_;
  FaceMotion::Noise variance_;  ///< of what is measured: means of squares
  double looks_ = 0.0;          ///< that these are means of
};

}  // namespace telemime
