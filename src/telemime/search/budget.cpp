// SPDX-License-Identifier: Apache-2.0
#include "telemime/search/budget.h"

#include <algorithm>
#include <cmath>

#include "telemime/core/errors.h"

namespace telemime {
namespace {

bool positive(double x) {
  return std::isfinite(x) && x > 0.0;
}

// The best x on the line within [low, high]. z there is k0 + k1 x + k2 x^2.
double best_on_line(const QuadraticFit& fit, double alpha, double beta, double rho, double low, double high) {
  const double ratio = alpha / beta;
  const double most_y = rho / beta;
  const double k1 = fit.b - fit.c * ratio + fit.g * most_y - 2.0 * fit.f * most_y * ratio;
  const double k2 = fit.d + fit.f * ratio * ratio - fit.g * ratio;
  const auto z = [&](double x) { return k1 * x + k2 * x * x; };
  double best = high;  // regions win a tie
  const double stationary = k2 > 0.0 ? std::clamp(-k1 / (2.0 * k2), low, high) : low;
  for (const double x : {stationary, low}) {
    best = z(x) < z(best) ? x : best;
  }
  return best;
}

}  // namespace

QuadraticFit default_fit() {
  return {
#include "budget_fit.inc"
  };
}

Allocation best_allocation(const QuadraticFit& fit, double alpha, double beta, double rho) {
  if (!positive(alpha) || !positive(beta) || !std::isfinite(rho) || rho < 0.0) {
    throw Error(ErrorKind::usage, "the cost of an evaluation must be above 0 and the budget not below");
  }
  const double most = (alpha + beta) * fit.limit;
  const double inside = std::min(rho, most);
  const double low = std::max(0.0, (inside - beta * fit.limit) / alpha);
  const double high = std::min(inside / alpha, fit.limit);
  const double x = best_on_line(fit, alpha, beta, inside, std::min(low, high), high);
  const double stretch = inside > 0.0 ? rho / inside : 1.0;
  return {x * stretch, std::max(0.0, (inside - alpha * x) / beta) * stretch};
}

Split split_for_budget(double budget_ms, double alpha_ms, double beta_ms, const QuadraticFit& fit) {
  const Allocation best = best_allocation(fit, alpha_ms, beta_ms, budget_ms);
  // Slightly more, so that 0.1 * 30 is still 3 after division and multiplication.
  constexpr double kRounding = 1e-9;
  constexpr double kMost = 1e6;
  Split split;
  split.region = static_cast<int>(std::min(kMost, std::floor(best.region + kRounding)));
  const double left = budget_ms - alpha_ms * split.region;
  split.edge = static_cast<int>(
      std::clamp(std::floor(left / beta_ms + kRounding), 0.0, std::min(kMost, std::ceil(best.edge))));
  return split;
}

}  // namespace telemime
