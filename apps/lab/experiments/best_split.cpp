// SPDX-License-Identifier: Apache-2.0
// Figures 3-28 to 3-30: the quadratic model of the 2-D error and the best split of a time budget.
#include <algorithm>
#include <cmath>

#include "lab/experiments/experiments.h"

namespace telemime {
namespace {

Table coefficients(const QuadraticFit& fit) {
  return {"coefficients",
          {"A", "B", "C", "D", "F", "G", "limit"},
          {row_of(fit.a, fit.b, fit.c, fit.d, fit.f, fit.g, fit.limit)}};
}

// Root mean square of the residuals of the fit, mm.
double misfit(Lab& lab, const QuadraticFit& fit) {
  const std::vector<ErrorSample> samples = lab.error_samples();
  double sum = 0.0;
  for (const ErrorSample& sample : samples) {
    sum += std::pow(sample.z - fit(sample.x, sample.y), 2);
  }
  return std::sqrt(sum / static_cast<double>(samples.size()));
}

// The best allocations for budgets from nothing to what the fit covers.
std::vector<Allocation> best_allocations(const QuadraticFit& fit, const EvaluationCost& cost) {
  std::vector<Allocation> curve;
  constexpr int kPoints = 100;
  const double most = fit.limit * (cost.region_ms + cost.edge_ms);
  for (int i = 1; i <= kPoints; ++i) {
    curve.push_back(best_allocation(fit, cost.region_ms, cost.edge_ms, most * i / kPoints));
  }
  return curve;
}

}  // namespace

Finding quadratic(Lab& lab) {
  const QuadraticFit fit = lab.fit();
  const double rest = misfit(lab, fit);
  return {.tables = {coefficients(fit)},
          .notes = {"z = A + B x + C y + D x^2 + F y^2 + G x y over the means of the four gestures; the root "
                    "mean square of its residuals is " +
                        number(rest) + " mm.",
                    "The error falls steeply at first and then hardly at all: a quadratic follows that only "
                    "roughly, and its minimum inside the square is partly an effect of its own shape."},
          .verdict =
              verdict({fit(fit.limit, fit.limit) < fit(0, 0), fit.b < 0.0},
                      "the fitted error is " + number(fit(0, 0)) + " mm without search and " +
                          number(fit(fit.limit, fit.limit)) + " mm with " + number(fit.limit) + " of each.")};
}

Finding tangent_point(Lab& lab) {
  const QuadraticFit fit = lab.fit();
  const EvaluationCost cost = evaluation_cost(lab, 160, 120);
  const double budget = 0.5 * fit.limit * (cost.region_ms + cost.edge_ms);
  const Allocation best = best_allocation(fit, cost.region_ms, cost.edge_ms, budget);
  constexpr int kPoints = 60;
  Table table{"along the line", {"region iterations", "edge iterations", "fitted 2-D error (mm)"}, {}};
  for (int i = 0; i <= kPoints; ++i) {
    const double x = std::min(fit.limit, budget / cost.region_ms) * i / kPoints;
    const double y = (budget - cost.region_ms * x) / cost.edge_ms;
    if (y <= fit.limit) {
      table.rows.push_back(row_of(x, y, fit(x, y)));
    }
  }
  return {.tables = {table},
          .notes = {"One F costs " + number(1e3 * cost.region_ms) + " us and one D_C " +
                    number(1e3 * cost.edge_ms) +
                    " us here. The printed equations 3.22 to 3.24 contain errors, so the quadratic along the "
                    "line is solved directly and its ends are compared."},
          .verdict = verdict({best.region > 0.0}, "for " + number(budget) + " ms the best is " +
                                                      number(std::round(best.region)) + " region and " +
                                                      number(std::round(best.edge)) + " edge iterations.")};
}

Finding best_curve(Lab& lab) {
  const QuadraticFit fit = lab.fit();
  const EvaluationCost cost = evaluation_cost(lab, 160, 120);
  const std::vector<Allocation> curve = best_allocations(fit, cost);
  Table table{"best split", {"total iterations", "region", "edge", "fitted 2-D error (mm)"}, {}};
  for (std::size_t i = 4; i < curve.size(); i += 5) {
    const auto& [region, edge] = curve[i];
    table.rows.push_back(row_of(region + edge, region, edge, fit(region, edge)));
  }
  // Total iterations from which edges get at least one.
  const auto first =
      std::find_if(curve.begin(), curve.end(), [](const Allocation& best) { return best.edge >= 1.0; });
  const bool edges = first != curve.end();
  const double total = edges ? first->region + first->edge : 0.0;
  return {.tables = {table, coefficients(fit)},
          .notes = {"`telemime-lab tune` measures the two costs on the host and applies this fit "
                    "(data/budget.json); beyond the measured square the split at its edge is kept."},
          .verdict = verdict({curve.front().edge == 0.0, edges && total >= 75.0 && total <= 400.0},
                             edges ? "edges get a share from about " + number(std::round(total)) +
                                         " iterations in total (thesis: about 150)."
                                   : "edges never get a share here.")};
}

}  // namespace telemime
