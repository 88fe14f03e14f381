// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "telemime/search/objective.h"

namespace telemime {

struct ShapeFitConfig {
  int iterations = 300;     ///< evaluations for a group of six numbers; proportionally more for larger groups
  bool share_sides = true;  ///< whether left and right limbs have the same scales
  double length_spread = 0.06;   ///< standard deviation, over people, of the logarithm of lengths
  double girth_spread = 0.15;    ///< the same for heights and widths
  double ratio_spread = 0.07;    ///< the same for upper arm length over forearm length
  double prior_weight = 0.004;   ///< weight of shape_prior
  double contour_weight = 0.15;  ///< weight of D_C beside F
};

struct ShapeFit {
  Shape shape;
  Pose pose;  ///< root translation and arm directions are fitted with the shape
  double cost = 0.0;
  int evaluations = 0;
};

/// Sum of the squared deviations of all logarithmic scales from the average body, in units of their spreads.
double shape_prior(const Shape& shape, const ShapeFitConfig& config);

/// Minimises the cues' costs over the 24 scales, the sleeve and the trunk's translation, in three groups:
/// trunk, head, arms (thesis 3.3, "shape adjustment"). One view cannot tell a large body far away from a
/// small one nearby: the prior keeps proportions human, the stature of `shape` sets the scale. The arms are
/// assumed to be parallel to the image plane with relaxed forearms; their directions in the image are fitted
/// together with their lengths.
ShapeFit fit_shape(Backend& backend, const PreparedFrame& frame, const Shape& shape, const Pose& pose,
                   const JointLimits& limits, const ShapeFitConfig& config);

}  // namespace telemime
