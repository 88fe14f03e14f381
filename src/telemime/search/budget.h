// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <limits>
#include <vector>

#include "telemime/core/random.h"
#include "telemime/likelihood/backend.h"

namespace telemime {

/// Mean 2-D error (mm) after x region and y edge evaluations per frame (thesis equation 3.19):
/// z = A + B x + C y + D x^2 + F y^2 + G x y. Fitted to measurements with 0 <= x, y <= `limit`.
struct QuadraticFit {
  double a = 0.0, b = 0.0, c = 0.0, d = 0.0, f = 0.0, g = 0.0;
  double limit = std::numeric_limits<double>::infinity();  ///< evaluations

  double operator()(double x, double y) const {
    return a + b * x + c * y + d * x * x + f * y * y + g * x * y;
  }
};

/// The fit to the 2-D errors of the four gestures (data/budget.json, thesis Figure 3-28).
QuadraticFit default_fit();

/// A point (x, y) of the plane of evaluations, not rounded.
struct Allocation {
  double region = 0.0;
  double edge = 0.0;
};

/// The point of alpha x + beta y = rho, x, y >= 0 with the smallest z (thesis 3.6.2.2; the quadratic on the
/// line is solved directly, its ends included). A tie gives more region evaluations. If rho allows more than
/// the fit was measured for, the best split inside its limit is scaled up. alpha, beta > 0 and rho >= 0 in
/// one unit of time; throws Error(usage) otherwise.
Allocation best_allocation(const QuadraticFit& fit, double alpha, double beta, double rho);

/// Whole evaluations of each step that fit into a budget.
struct Split {
  int region = 0;
  int edge = 0;
  int total() const { return region + edge; }
  /// Share of the region step, for RegistrationConfig; 1 when nothing fits.
  double region_share() const { return total() > 0 ? static_cast<double>(region) / total() : 1.0; }
};

/// best_allocation rounded down, so that it never exceeds `budget_ms`. Times in ms.
Split split_for_budget(double budget_ms, double alpha_ms, double beta_ms, const QuadraticFit& fit);

/// Time of one evaluation on this machine at one working size.
struct EvaluationCost {
  int width = 0;
  int height = 0;
  double region_ms = 0.0;  ///< alpha: one F
  double edge_ms = 0.0;    ///< beta: one D_C
};

/// A frame rendered from the model in this pose: labels and distance map are exact, so that F is 0 there. For
/// measurements and tests.
PreparedFrame frame_of_model(const Model& model, const Pose& pose, const Camera& camera);

/// `count` random poses about a person at 1.2 m with raised forearms, as a search would evaluate them.
std::vector<Pose> typical_poses(std::size_t count, Random& random);

/// Median over `repeats` passes of the time of one F and of one D_C evaluation, over typical poses, at the
/// size of `camera`. `seconds` is the clock.
EvaluationCost measure_cost(Backend& backend, const Model& model, const Camera& camera, int repeats,
                            Random& random, const std::function<double()>& seconds);

}  // namespace telemime
