// SPDX-License-Identifier: Apache-2.0
#include "telemime/search/simplex.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "telemime/core/errors.h"

namespace telemime {
namespace {

using Eigen::VectorXd;
using Cost = std::function<double(const VectorXd&)>;

Bounds box(int n, double low, double high) {
  return {VectorXd::Constant(n, low), VectorXd::Constant(n, high)};
}

SimplexOptions options(int evaluations, double tolerance = 1e-12) {
  SimplexOptions o;
  o.max_evaluations = evaluations;
  o.tolerance = tolerance;
  return o;
}

SimplexResult search(const Cost& cost, const VectorXd& start, const Bounds& bounds, const SimplexOptions& o) {
  return minimise(cost, axis_simplex(start, VectorXd::Constant(start.size(), 0.5), bounds), bounds, o);
}

double rosenbrock(const VectorXd& x) {
  return std::pow(1 - x[0], 2) + 100 * std::pow(x[1] - x[0] * x[0], 2);
}

TEST(Simplex, FindsTheMinimumOfAQuadratic) {
  for (const int n : {1, 2, 5, 9}) {
    VectorXd goal(n);
    for (int i = 0; i < n; ++i) {
      goal[i] = 0.3 * i - 0.7;
    }
    const auto cost = [&](const VectorXd& x) {
      double sum = 1.0;  // the tolerance is relative
      for (int i = 0; i < n; ++i) {
        sum += (1 + i) * std::pow(x[i] - goal[i], 2);
      }
      return sum;
    };
    const SimplexResult r = search(cost, VectorXd::Zero(n), box(n, -10, 10), options(4000));
    EXPECT_LT((r.best().point - goal).norm(), 1e-4) << n;
    EXPECT_EQ(r.reason, StopReason::converged) << n;
    EXPECT_EQ(r.simplex.size(), static_cast<std::size_t>(n) + 1);
  }
}

TEST(Simplex, FindsTheMinimumOfRosenbrocksValley) {
  VectorXd start(2);
  start << -1.2, 1.0;
  const SimplexResult r = search(rosenbrock, start, box(2, -5, 5), options(1000));
  EXPECT_LT((r.best().point - VectorXd::Ones(2)).norm(), 1e-3);
  EXPECT_LT(r.evaluations, 400);
}

TEST(Simplex, FindsAMinimumOnTheBorder) {
  const auto cost = [](const VectorXd& x) { return (x - VectorXd::Constant(3, 4.0)).squaredNorm(); };
  const SimplexResult r = search(cost, VectorXd::Zero(3), box(3, -1, 1), options(2000));
  EXPECT_LT((r.best().point - VectorXd::Ones(3)).norm(), 1e-2);
}

TEST(Simplex, LooksNowhereOutsideTheBounds) {
  const Bounds bounds = {VectorXd::Constant(4, -0.3), VectorXd::Constant(4, 0.6)};
  int looked = 0;
  const auto cost = [&](const VectorXd& x) {
    ++looked;
    EXPECT_TRUE((x.array() >= bounds.low.array()).all() && (x.array() <= bounds.high.array()).all());
    return (x - VectorXd::Constant(4, 2.0)).squaredNorm();
  };
  // Also from a start outside the bounds.
  const SimplexResult r = search(cost, VectorXd::Constant(4, 5.0), bounds, options(300));
  EXPECT_GT(looked, 5);
  for (const Vertex& v : r.simplex) {
    EXPECT_TRUE((v.point.array() >= bounds.low.array()).all() &&
                (v.point.array() <= bounds.high.array()).all());
  }
}

TEST(Simplex, NeverEvaluatesMoreThanAllowed) {
  for (const int most : {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 17, 50, 51, 52, 200}) {
    int looked = 0;
    const auto cost = [&](const VectorXd& x) {
      ++looked;
      return rosenbrock(x) + x.squaredNorm();
    };
    const SimplexResult r = search(cost, VectorXd::Constant(4, -1.0), box(4, -5, 5), options(most, 0.0));
    EXPECT_EQ(looked, r.evaluations);
    EXPECT_LE(looked, most);
    EXPECT_GE(looked, std::min(most, 5)) << "what is allowed is used";
    ASSERT_FALSE(r.simplex.empty());
    EXPECT_EQ(r.simplex.size(), static_cast<std::size_t>(std::min(most, 5)));
  }
}

TEST(Simplex, VerticesComeBackSortedWithTheirOwnCosts) {
  VectorXd start(2);
  start << -1.2, 1.0;
  double least = std::numeric_limits<double>::infinity();
  const auto cost = [&](const VectorXd& x) {
    least = std::min(least, rosenbrock(x));
    return rosenbrock(x);
  };
  for (const int most : {2, 10, 33, 100}) {
    least = std::numeric_limits<double>::infinity();
    const SimplexResult r = search(cost, start, box(2, -5, 5), options(most));
    EXPECT_EQ(r.best().cost, least) << "the best point that was seen is never lost";
    for (std::size_t i = 0; i < r.simplex.size(); ++i) {
      EXPECT_EQ(r.simplex[i].cost, rosenbrock(r.simplex[i].point));
      EXPECT_TRUE(i == 0 || r.simplex[i - 1].cost <= r.simplex[i].cost);
    }
  }
}

TEST(Simplex, IsDeterministic) {
  VectorXd start(2);
  start << -1.2, 1.0;
  const SimplexResult a = search(rosenbrock, start, box(2, -5, 5), options(77));
  const SimplexResult b = search(rosenbrock, start, box(2, -5, 5), options(77));
  EXPECT_EQ(a.best().point, b.best().point);
  EXPECT_EQ(a.evaluations, b.evaluations);
}

TEST(Simplex, FlatCostConvergesAtOnce) {
  const SimplexResult r =
      search([](const VectorXd&) { return 3.0; }, VectorXd::Zero(3), box(3, -1, 1), options(500));
  EXPECT_EQ(r.reason, StopReason::converged);
  EXPECT_EQ(r.evaluations, 4);
}

TEST(Simplex, SaysWhenTheEvaluationsRanOut) {
  VectorXd start(2);
  start << -1.2, 1.0;
  EXPECT_EQ(search(rosenbrock, start, box(2, -5, 5), options(20)).reason, StopReason::evaluations);
}

TEST(Simplex, RefusesSizesThatDoNotMatch) {
  const auto cost = [](const VectorXd& x) { return x.sum(); };
  const std::vector<VectorXd> two = {VectorXd::Zero(2), VectorXd::Ones(2)};
  const std::vector<VectorXd> three = {VectorXd::Zero(2), VectorXd::Ones(2), VectorXd::Constant(2, 0.5)};
  EXPECT_NO_THROW(minimise(cost, three, box(2, -5, 5), options(10)));
  for (const auto& start : {std::vector<VectorXd>{}, two}) {
    EXPECT_THROW(minimise(cost, start, box(2, -5, 5), options(10)), Error);
  }
  EXPECT_THROW(minimise(cost, three, box(3, -5, 5), options(10)), Error);
}

TEST(AxisSimplex, HasOneVertexAlongEachAxis) {
  const VectorXd start = VectorXd::Constant(3, 0.25);
  VectorXd steps(3);
  steps << 0.1, 0.2, 0.3;
  const auto points = axis_simplex(start, steps, box(3, -1, 1));
  ASSERT_EQ(points.size(), 4U);
  EXPECT_EQ(points[0], start);
  for (Eigen::Index i = 0; i < 3; ++i) {
    const VectorXd way = points[static_cast<std::size_t>(i) + 1] - start;
    EXPECT_NEAR(way[i], steps[i], 1e-15);
    EXPECT_NEAR(way.norm(), steps[i], 1e-15);
  }
}

TEST(AxisSimplex, StepsMayGoBack) {
  VectorXd steps(2);
  steps << -0.5, 0.5;
  const auto inside = axis_simplex(VectorXd::Zero(2), steps, box(2, -1, 1));
  EXPECT_NEAR(inside[1][0], -0.5, 1e-15);
  EXPECT_NEAR(inside[2][1], 0.5, 1e-15);
  const auto turned = axis_simplex(VectorXd::Constant(2, -0.9), steps, box(2, -1, 1));
  EXPECT_NEAR(turned[1][0], -0.4, 1e-15);
}

TEST(AxisSimplex, TurnsAroundAtTheBorder) {
  const VectorXd steps = VectorXd::Constant(2, 0.5);
  const auto points = axis_simplex(VectorXd::Constant(2, 0.9), steps, box(2, -1, 1));
  EXPECT_NEAR(points[1][0], 0.4, 1e-15);
  EXPECT_NEAR(points[2][1], 0.4, 1e-15);
  // In bounds smaller than the steps it takes the wider side.
  const auto squeezed =
      axis_simplex(VectorXd::Constant(1, 0.02), VectorXd::Constant(1, 9.0), box(1, 0.0, 0.1));
  EXPECT_NEAR(squeezed[1][0], 0.1, 1e-15);
}

TEST(RestartSimplex, KeepsALivelySimplex) {
  const std::vector<Vertex> simplex = {{VectorXd::Zero(2), 1.0},
                                       {(VectorXd(2) << 0.5, 0.1).finished(), 2.0},
                                       {(VectorXd(2) << 0.0, 0.4).finished(), 3.0}};
  const auto points = restart_simplex(simplex, VectorXd::Constant(2, 0.2), box(2, -1, 1));
  ASSERT_EQ(points.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(points[i], simplex[i].point);
  }
}

TEST(RestartSimplex, BlowsUpACollapsedOneAboutItsBest) {
  const VectorXd best = VectorXd::Constant(3, 0.5);
  std::vector<Vertex> collapsed(4, {best, 1.0});
  collapsed[1].point[0] += 0.4;  // extends along one axis only
  const VectorXd least = VectorXd::Constant(3, 0.1);
  const auto points = restart_simplex(collapsed, least, box(3, -1, 1));
  ASSERT_EQ(points.size(), 4U);
  EXPECT_EQ(points[0], best);
  EXPECT_NEAR(std::abs((points[1] - best)[0]), 0.4, 1e-12);
  EXPECT_NEAR(std::abs((points[2] - best)[1]), 0.1, 1e-12);
  EXPECT_NEAR(std::abs((points[3] - best)[2]), 0.1, 1e-12);
  // A search can move from there, which it cannot from a collapsed simplex.
  const auto cost = [](const VectorXd& x) { return x.squaredNorm(); };
  const SimplexResult r = minimise(cost, points, box(3, -1, 1), options(500));
  EXPECT_LT(r.best().point.norm(), 1e-3);
}

}  // namespace
}  // namespace telemime
