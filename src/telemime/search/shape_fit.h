// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "telemime/search/objective.h"

namespace telemime {

struct ShapeFitConfig {
  int iterations = 300;          ///< evaluations for a group of six numbers, more for larger ones
  bool share_sides = true;       ///< left and right limbs have the same scales
  double length_spread = 0.06;   ///< standard deviation of the logarithm of lengths over people
  double girth_spread = 0.15;    ///< the same of heights and widths
  double ratio_spread = 0.07;    ///< of the logarithm of upper arm over forearm
  double prior_weight = 0.004;   ///< of the squared deviations from the average body
  double contour_weight = 0.15;  ///< of D_C beside F
};

struct ShapeFit {
  Shape shape;
  Pose pose;  ///< the root's translation is fitted with the trunk
  double cost = 0.0;
  int evaluations = 0;
};

/// Squared deviation of the logarithms of all scales from the average body, over their spreads.
double shape_prior(const Shape& shape, const ShapeFitConfig& config);

/// Minimises F (and D_C) over the 24 scales, the sleeve and the trunk's translation, in three groups: trunk,
/// head, arms (thesis 3.3, "shape adjustment"). One view cannot tell a big body far away from a small one
/// nearby: the prior keeps proportions human, the stature of `shape` sets the scale. The arms are taken to be
/// parallel to the image, forearms relaxed: their directions in the image are fitted with their lengths, and
/// the pose that comes back has them.
ShapeFit fit_shape(Backend& backend, const PreparedFrame& frame, const Shape& shape, const Pose& pose,
                   const JointLimits& limits, const ShapeFitConfig& config);

}  // namespace telemime
