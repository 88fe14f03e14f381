// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "telemime/body/hand_motion.h"

namespace telemime {

/// Cutoff frequency (Hz) of the way of a hand that is not seen to rest: 85 % in half a second.
inline constexpr double kHandRestCutoff = 1.0;

/// How far the measured angles of one hand's fingers are wrong, frame by frame: as its visibility says, or as
/// its jitter does.
class HandNoise {
 public:
  /// What the first three angles of each finger change by, rad.
  using Changes = std::array<Eigen::Vector3d, kFingerCount>;

  HandNoise() { change_.fill(Eigen::Vector3d::Zero()); }

  /// Takes the hand of the next frame, `step` seconds after the last.
  void observe(const HandMotion& measured, double step);
  /// Since the frame before; none where a hand comes into sight: the way from its form at rest is not a
  /// motion.
  const Changes& change() const { return change_; }
  /// From 0 to 1 the longer the hand is not seen.
  double resting() const { return resting_; }
  /// Of an angle, rad^2. A hand that is no longer seen may be anywhere, and is at rest after a while.
  double variance() const;
  /// The same, as a multiple of that of a hand that is seen well.
  double ratio() const;

 private:
  std::optional<HandMotion> last_;
  Changes change_;
  double resting_ = 0.0;
  double by_visibility_ = 0.0;  // variance
  double by_jitter_ = 0.0;      // variance of white noise that explains the changes; negative in motion
};

}  // namespace telemime
