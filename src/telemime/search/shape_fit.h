// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "telemime/search/objective.h"

namespace telemime {

/// Settings of fit_shape; part of the table of CalibrationConfig.
struct ShapeFitConfig {
  int iterations = 300;
  double length_spread = 0.06;
  double girth_spread = 0.15;
  double ratio_spread = 0.07;
  double prior_weight = 0.004;
  double contour_weight = 0.15;
};

struct ShapeFit {
  Shape shape;
  Pose pose;  ///< root translation and arm directions are fitted with the shape
  double cost = 0.0;
  int evaluations = 0;
};

/// The same of the distance between the shoulder joints, which varies over people as lengths do.
double shoulder_prior(const Shape& shape, const ShapeFitConfig& config);

/// Mean of the squared deviations of all logarithmic scales from the average body, in units of their spreads,
/// plus those of the ratios of the upper arms to the forearms.
double shape_prior(const Shape& shape, const ShapeFitConfig& config);

/// Minimises the cues' costs over the 24 scales, the sleeve and the trunk's translation, in three groups:
/// trunk, head, arms (thesis 3.3, "shape adjustment"). One view cannot tell a large body far away from a
/// small one nearby: the prior keeps proportions human, the stature of `shape` sets the scale. The arms are
/// assumed to be parallel to the image plane with relaxed forearms; their directions in the image are fitted
/// together with their lengths.
ShapeFit fit_shape(Backend& backend, const PreparedFrame& frame, const Shape& shape, const Pose& pose,
                   const JointLimits& limits, const ShapeFitConfig& config);

}  // namespace telemime
