// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "telemime/core/random.h"
#include "telemime/likelihood/backend.h"

namespace telemime {

/// Mean 2-D error (mm) after x region and y edge evaluations a frame (thesis equation 3.19):
/// z = A + B x + C y + D x^2 + F y^2 + G x y. Only measured for 0 <= x, y <= `limit`.
struct QuadraticFit {
  double a = 0.0, b = 0.0, c = 0.0, d = 0.0, f = 0.0, g = 0.0;
  double limit = std::numeric_limits<double>::infinity();  ///< evaluations

  double operator()(double x, double y) const {
    return a + b * x + c * y + d * x * x + f * y * y + g * x * y;
  }
};

/// The fit to the 2-D errors of the four gestures (data/budget.json, thesis Figure 3-28).
QuadraticFit default_fit();

/// One measurement: the error after x region and y edge evaluations.
struct ErrorSample {
  double x = 0.0;
  double y = 0.0;
  double z = 0.0;  ///< mm
};

/// Least-squares fit; `limit` becomes the largest x or y. Throws Error(usage) unless the samples determine
/// all six coefficients.
QuadraticFit fit_quadratic(std::span<const ErrorSample> samples);

/// A point (x, y) of the plane of evaluations, not rounded.
struct Allocation {
  double region = 0.0;
  double edge = 0.0;
};

/// The point of alpha x + beta y = rho, x, y >= 0 with the smallest z (thesis 3.6.2.2; the line's quadratic
/// is solved directly, its ends included). On a tie, more regions. Where rho buys more than the fit was
/// measured for, the best split inside its limit is stretched. alpha, beta > 0 and rho >= 0 in one unit of
/// time; throws Error(usage) otherwise.
Allocation best_allocation(const QuadraticFit& fit, double alpha, double beta, double rho);

/// Whole evaluations of each step that fit into a budget.
struct Split {
  int region = 0;
  int edge = 0;
  int total() const { return region + edge; }
  /// Share of the region step, for RegistrationConfig; 1 when nothing fits.
  double region_share() const { return total() > 0 ? static_cast<double>(region) / total() : 1.0; }
};

/// best_allocation rounded down, so that it never takes longer than `budget_ms`. Times in ms.
Split split_for_budget(double budget_ms, double alpha_ms, double beta_ms, const QuadraticFit& fit);

/// What one evaluation costs on this machine at one working size.
struct EvaluationCost {
  int width = 0;
  int height = 0;
  double region_ms = 0.0;  ///< alpha: one F
  double edge_ms = 0.0;    ///< beta: one D_C
};

/// What `telemime-lab tune` measures and writes.
struct Tuning {
  QuadraticFit fit;
  std::vector<EvaluationCost> costs;

  /// The cost at this size; a size that was not measured takes that of the nearest one in pixels. Throws
  /// Error(config) when none was.
  EvaluationCost cost_at(int width, int height) const;
};

/// Reads the text of tuning_json() or data/budget.json, which has a fit only. Throws Error(config) that names
/// the file and what is wrong.
Tuning read_tuning(const std::filesystem::path& file);

/// The JSON text; with `budget_ms` > 0 also the split of each size.
std::string tuning_json(const Tuning& tuning, double budget_ms);

/// The frame in which the model itself stands in this pose: labels and distance map without any error, so
/// that F is 0 there. For measurements and tests.
PreparedFrame frame_of_model(const Model& model, const Pose& pose, const Camera& camera);

/// Person at 1.2 m, forearms raised before the body: `count` poses about there, as a search would try them.
std::vector<Pose> typical_poses(std::size_t count, Random& random);

/// Median over `repeats` passes of the time of one F and of one D_C evaluation, over typical poses, at the
/// size of `camera`. `seconds` is the clock.
EvaluationCost measure_cost(Backend& backend, const Model& model, const Camera& camera, int repeats,
                            Random& random, const std::function<double()>& seconds);

}  // namespace telemime
