// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "telemime/body/motion_frame.h"
#include "telemime/evaluation/truth.h"

namespace telemime {

/// How far the fingers of hands that are seen are from the truth.
struct HandReport {
  std::size_t hands = 0;                   ///< true hands in the image, each frame counted
  double seen = 0.0;                       ///< share of these with a visibility of at least 0.5
  std::optional<double> palm_aligned;      ///< m, mean of the finger joints of hands that are seen
  std::optional<double> palm_aligned_p95;  ///< m, of the hands' means
};

/// Mean distance (m) of the joints beyond the palm after the rigid motion that brings the five points of the
/// palm together (least squares, without a scale).
double palm_aligned_error(const HandPoints& estimate, const HandPoints& truth);

/// Over scored, tracked frames, whose hands are first multiplied by `scale`, as the poses are for a truth of
/// unknown scale. Nothing if the truth knows no hands or no frame has any.
std::optional<HandReport> measure_hands(const std::vector<MotionFrame>& frames, const Truth& truth,
                                        double scale = 1.0);

}  // namespace telemime
