// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "telemime/body/hand_model.h"

namespace telemime {

/// The likeliest hand behind points that a network saw.
struct HandFit {
  Eigen::Matrix3d frame_from_hand;  ///< camera frame
  HandAngles angles;
  double scale = 1.0;  ///< of the points, per m of the sizes
  double error = 0.0;  ///< m, root mean square distance from the points; depths count by their weight only
  double cost = 0.0;   ///< sum of squares in standard deviations
};

/// `points` in m from the wrist, z about along the line of sight. Along x and y they are right to 8 mm, in
/// depth to 24 mm and apart from a tilt of the whole hand, which the network sees badly. The lengths of the
/// bones, the limits of the angles, rest, and what neighbouring fingers do together decide the remainder:
/// Gauss-Newton from palm_rotation() and a hand at rest, damped (Levenberg 1944). Empty like palm_rotation().
std::optional<HandFit> likeliest_hand(const HandSizes& sizes, const HandPoints& points, Side side);

}  // namespace telemime
