// SPDX-License-Identifier: Apache-2.0
// Figures 3-28 to 3-30: the quadratic model of the 2-D error and the best split of a time budget.
#include <cmath>

#include "lab/experiments/experiments.h"
#include "lab/experiments/timing.h"

namespace telemime {
namespace {

Table coefficients(const QuadraticFit& fit) {
  Table table{"coefficients", {"A", "B", "C", "D", "F", "G", "limit"}, {}};
  table.rows.push_back({number(fit.a), number(fit.b), number(fit.c), number(fit.d), number(fit.f),
                        number(fit.g), number(fit.limit)});
  return table;
}

// Root mean square of the residuals of the fit, mm.
double misfit(Lab& lab, const QuadraticFit& fit) {
  const Grid& grid = lab.grid();
  const std::size_t n = grid.steps.size();
  double sum = 0.0;
  for (std::size_t e = 0; e < n; ++e) {
    for (std::size_t r = 0; r < n; ++r) {
      double mean = 0.0;
      for (std::size_t s = 0; s < lab.gestures().size(); ++s) {
        mean += grid.at(s, e, r).error_2d / static_cast<double>(lab.gestures().size());
      }
      const double d = mean - fit(grid.steps[r], grid.steps[e]);
      sum += d * d;
    }
  }
  return std::sqrt(sum / static_cast<double>(n * n));
}

// The best allocation for budgets from nothing to what the fit covers.
struct Curve {
  std::vector<double> total;
  std::vector<double> region;
  std::vector<double> edge;
  double first_edges = 0.0;  ///< total iterations from which edges get at least one; 0: never
};

Curve curve_of(const QuadraticFit& fit, const EvaluationCost& cost) {
  Curve curve;
  constexpr int kPoints = 100;
  const double most = fit.limit * (cost.region_ms + cost.edge_ms);
  for (int i = 1; i <= kPoints; ++i) {
    const Allocation best = best_allocation(fit, cost.region_ms, cost.edge_ms, most * i / kPoints);
    curve.total.push_back(best.region + best.edge);
    curve.region.push_back(best.region);
    curve.edge.push_back(best.edge);
    if (curve.first_edges == 0.0 && best.edge >= 1.0) {
      curve.first_edges = best.region + best.edge;
    }
  }
  return curve;
}

}  // namespace

Finding quadratic(Lab& lab) {
  const QuadraticFit fit = lab.fit();
  const double rest = misfit(lab, fit);
  Finding finding;
  finding.tables = {coefficients(fit)};
  finding.notes = {
      "z = A + B x + C y + D x^2 + F y^2 + G x y over the means of the four gestures; the root mean square "
      "of "
      "its residuals is " +
          number(rest) + " mm.",
      "The error falls steeply at first and then hardly at all: a quadratic follows that only roughly, and "
      "its minimum inside the square is partly an effect of its own shape."};
  finding.verdict =
      verdict({fit(fit.limit, fit.limit) < fit(0, 0), fit.b < 0.0},
              "the fitted error is " + number(fit(0, 0)) + " mm without search and " +
                  number(fit(fit.limit, fit.limit)) + " mm with " + number(fit.limit) + " of each.");
  return finding;
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
      table.rows.push_back({number(x), number(y), number(fit(x, y))});
    }
  }
  Finding finding;
  finding.tables = {table};
  finding.notes = {"One F costs " + number(1e3 * cost.region_ms) + " us and one D_C " +
                   number(1e3 * cost.edge_ms) +
                   " us here. The printed equations 3.22 to 3.24 contain errors, so "
                   "the quadratic along the line is solved directly and its ends are compared."};
  finding.verdict = verdict({best.region > 0.0}, "for " + number(budget) + " ms the best is " +
                                                     number(std::round(best.region)) + " region and " +
                                                     number(std::round(best.edge)) + " edge iterations.");
  return finding;
}

Finding best_curve(Lab& lab) {
  const QuadraticFit fit = lab.fit();
  const EvaluationCost cost = evaluation_cost(lab, 160, 120);
  const Curve curve = curve_of(fit, cost);
  Finding finding;
  Table table{"best split", {"total iterations", "region", "edge", "fitted 2-D error (mm)"}, {}};
  for (std::size_t i = 4; i < curve.total.size(); i += 5) {
    table.rows.push_back({number(curve.total[i]), number(curve.region[i]), number(curve.edge[i]),
                          number(fit(curve.region[i], curve.edge[i]))});
  }
  finding.tables = {table, coefficients(fit)};
  finding.notes = {
      "`telemime-lab tune` measures the two costs on the host and applies this fit (data/budget.json); "
      "beyond "
      "the measured square the split at its edge is kept."};
  const bool edges = curve.first_edges > 0.0;
  finding.verdict =
      verdict({curve.edge.front() == 0.0, edges && curve.first_edges >= 75.0 && curve.first_edges <= 400.0},
              edges ? "edges get a share from about " + number(std::round(curve.first_edges)) +
                          " iterations in total (thesis: about 150)."
                    : "edges never get a share here.");
  return finding;
}

}  // namespace telemime
