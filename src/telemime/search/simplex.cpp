// SPDX-License-Identifier: Apache-2.0
#include "telemime/search/simplex.h"

#include <algorithm>
#include <cmath>

#include "telemime/core/errors.h"

namespace telemime {
namespace {

Eigen::VectorXd project(const Eigen::VectorXd& point, const Bounds& bounds) {
  return point.cwiseMax(bounds.low).cwiseMin(bounds.high);
}

}  // namespace

std::vector<Eigen::VectorXd> axis_simplex(const Eigen::VectorXd& start, const Eigen::VectorXd& steps,
                                          const Bounds& bounds) {
  const Eigen::VectorXd origin = project(start, bounds);
  std::vector<Eigen::VectorXd> points = {origin};
  for (Eigen::Index i = 0; i < origin.size(); ++i) {
    Eigen::VectorXd point = origin;
    const auto way = [&](double step) {
      return std::clamp(origin[i] + step, bounds.low[i], bounds.high[i]) - origin[i];
    };
    const double there = way(steps[i]);
    const double back = way(-steps[i]);
    const bool free = std::abs(there) >= 0.999 * std::abs(steps[i]);
    point[i] = origin[i] + (free || std::abs(there) >= std::abs(back) ? there : back);
    points.push_back(point);
  }
  return points;
}

std::vector<Eigen::VectorXd> restart_simplex(const std::vector<Vertex>& simplex, const Eigen::VectorXd& least,
                                             const Bounds& bounds) {
  const Eigen::VectorXd& best = simplex.front().point;
  Eigen::VectorXd extent = Eigen::VectorXd::Zero(best.size());
  for (const Vertex& v : simplex) {
    extent = extent.cwiseMax((v.point - best).cwiseAbs());
  }
  if ((extent.array() < least.array()).any()) {
    return axis_simplex(best, extent.cwiseMax(least), bounds);
  }
  std::vector<Eigen::VectorXd> points;
  points.reserve(simplex.size());
  for (const Vertex& v : simplex) {
    points.push_back(project(v.point, bounds));
  }
  return points;
}

SimplexResult minimise(const std::function<double(const Eigen::VectorXd&)>& cost,
                       const std::vector<Eigen::VectorXd>& start, const Bounds& bounds,
                       const SimplexOptions& options) {
  if (start.empty() || bounds.low.size() != start.front().size() ||
      bounds.high.size() != start.front().size() ||
      start.size() != static_cast<std::size_t>(start.front().size()) + 1) {
    throw Error(ErrorKind::usage, "simplex: n + 1 start points and bounds of n numbers are needed");
  }
  SimplexResult result;
  const auto evaluate = [&](const Eigen::VectorXd& point) {
    ++result.evaluations;
    Vertex v = {project(point, bounds), 0.0};
    v.cost = cost(v.point);
    return v;
  };
  const auto by_cost = [](const Vertex& a, const Vertex& b) { return a.cost < b.cost; };

  // Evaluate the start; stable sorting keeps equal vertices in order, so that equal input gives equal
  // results.
  std::vector<Vertex>& s = result.simplex;
  for (const Eigen::VectorXd& point : start) {
    if (result.evaluations < std::max(1, options.max_evaluations)) {
      s.push_back(evaluate(point));
    }
  }
  std::stable_sort(s.begin(), s.end(), by_cost);
  const bool complete = s.size() == start.size();
  while (complete && result.evaluations < options.max_evaluations) {
    // Converged when best and worst differ by less than the tolerance.
    const double spread = s.back().cost - s.front().cost;
    if (spread <= options.tolerance * 0.5 * (std::abs(s.back().cost) + std::abs(s.front().cost)) ||
        !(spread > 0.0)) {
      result.reason = StopReason::converged;
      break;
    }
    // Centroid of all vertices but the worst.
    Eigen::VectorXd centre = Eigen::VectorXd::Zero(s.front().point.size());
    for (std::size_t i = 0; i + 1 < s.size(); ++i) {
      centre += s[i].point;
    }
    centre /= static_cast<double>(s.size() - 1);

    // Replace the worst vertex: reflect, expand, contract or shrink.
    Vertex& worst = s.back();
    const Vertex& second_worst = s[s.size() - 2];
    const Vertex reflected = evaluate(centre + options.reflection * (centre - worst.point));
    if (reflected.cost < s.front().cost && result.evaluations < options.max_evaluations) {
      const Vertex expanded = evaluate(centre + options.expansion * (centre - worst.point));
      worst = expanded.cost < reflected.cost ? expanded : reflected;
    } else if (reflected.cost < second_worst.cost) {
      worst = reflected;
    } else if (result.evaluations < options.max_evaluations) {
      const Vertex& toward = reflected.cost < worst.cost ? reflected : worst;
      const Vertex contracted = evaluate(centre + options.contraction * (toward.point - centre));
      if (contracted.cost < toward.cost) {
        worst = contracted;
      } else {
        for (std::size_t i = 1; i < s.size() && result.evaluations < options.max_evaluations; ++i) {
          s[i] = evaluate(s[0].point + options.shrink * (s[i].point - s[0].point));
        }
      }
    }
    std::stable_sort(s.begin(), s.end(), by_cost);
  }
  return result;
}

}  // namespace telemime
