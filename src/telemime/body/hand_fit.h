// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "telemime/body/hand_model.h"

namespace telemime {

/// The likeliest hand behind points that a network saw.
struct LikelyHand {
  HandFit fit;        ///< `error` counts depths by their weight only
  double cost = 0.0;  ///< sum of squares in standard deviations
};

/// `points` in m from the wrist, z about along the line of sight. Along x and y they are right to 8 mm, in
/// depth to 24 mm and apart from a tilt of the whole hand, which the network sees badly. The lengths of the
/// bones, the limits of the angles, rest, and what neighbouring fingers do together decide the remainder:
/// Gauss-Newton from the palm of `fit_hand`, damped (Levenberg 1944). Empty like `fit_hand`.
std::optional<LikelyHand> likeliest_hand(const HandSizes& sizes, const HandPoints& points, Side side);

}  // namespace telemime
