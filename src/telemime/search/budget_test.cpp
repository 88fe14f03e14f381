// SPDX-License-Identifier: Apache-2.0
#include "telemime/search/budget.h"

#include <gtest/gtest.h>

#include <cmath>

#include "telemime/core/errors.h"

namespace telemime {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(BestAllocation, SolvesACaseByHand) {
  // z = (x - 30)^2 + (y - 10)^2 on x + y = 60: the foot of the perpendicular from (30, 10) is (40, 20).
  const QuadraticFit fit{1000.0, -60.0, -20.0, 1.0, 1.0, 0.0, kInfinity};
  const Allocation best = best_allocation(fit, 1.0, 1.0, 60.0);
  EXPECT_NEAR(best.region, 40.0, 1e-9);
  EXPECT_NEAR(best.edge, 20.0, 1e-9);
}

TEST(BestAllocation, TakesTheEndWhenTheMinimumLiesBeyond) {
  const QuadraticFit regions{0.0, -1.0, -0.1, 0.0, 0.0, 0.0, kInfinity};
  EXPECT_NEAR(best_allocation(regions, 2.0, 1.0, 100.0).region, 50.0, 1e-9);
  EXPECT_NEAR(best_allocation(regions, 2.0, 1.0, 100.0).edge, 0.0, 1e-9);
  const QuadraticFit edges{0.0, -0.1, -1.0, 0.0, 0.0, 0.0, kInfinity};
  EXPECT_NEAR(best_allocation(edges, 1.0, 2.0, 100.0).region, 0.0, 1e-9);
  EXPECT_NEAR(best_allocation(edges, 1.0, 2.0, 100.0).edge, 50.0, 1e-9);
}

TEST(BestAllocation, ASaddleAlongTheLineGoesToItsBetterEnd) {
  const QuadraticFit fit{0.0, 0.0, -1.0, -1.0, -1.0, 0.0, kInfinity};
  EXPECT_NEAR(best_allocation(fit, 1.0, 1.0, 10.0).edge, 10.0, 1e-9);
}

TEST(BestAllocation, NoPointOfTheLineIsBetter) {
  Random random(11);
  for (int trial = 0; trial < 200; ++trial) {
    QuadraticFit fit;
    fit.b = random.normal();
    fit.c = random.normal();
    fit.d = random.normal(0.0, 0.01);
    fit.f = random.normal(0.0, 0.01);
    fit.g = random.normal(0.0, 0.01);
    const double alpha = random.uniform(0.1, 3.0);
    const double beta = random.uniform(0.1, 3.0);
    const double rho = random.uniform(0.0, 300.0);
    const Allocation best = best_allocation(fit, alpha, beta, rho);
    EXPECT_NEAR(alpha * best.region + beta * best.edge, rho, 1e-9 * (1.0 + rho));
    for (int i = 0; i <= 100; ++i) {
      const double x = rho / alpha * i / 100.0;
      const double y = (rho - alpha * x) / beta;
      EXPECT_LE(fit(best.region, best.edge), fit(x, y) + 1e-6);
    }
  }
}

TEST(BestAllocation, BeyondTheFitTheSplitInsideIsStretched) {
  const QuadraticFit fit{100.0, -1.0, -1.0, 1e-3, 1e-3, 0.0, 200.0};
  const Allocation corner = best_allocation(fit, 1.0, 3.0, 4000.0);
  EXPECT_NEAR(corner.region, 1000.0, 1e-6);
  EXPECT_NEAR(corner.edge, 1000.0, 1e-6);
  const Allocation edge_of_fit = best_allocation(fit, 1.0, 1.0, 390.0);
  EXPECT_LE(edge_of_fit.region, 200.0 + 1e-9);
  EXPECT_LE(edge_of_fit.edge, 200.0 + 1e-9);
}

TEST(BestAllocation, RefusesCostsThatAreNotPositive) {
  EXPECT_THROW(best_allocation({}, 0.0, 1.0, 1.0), Error);
  EXPECT_THROW(best_allocation({}, 1.0, -1.0, 1.0), Error);
  EXPECT_THROW(best_allocation({}, 1.0, 1.0, std::nan("")), Error);
}

TEST(SplitForBudget, StaysInTheBudgetAndWastesLittle) {
  Random random(3);
  const QuadraticFit fit{100.0, -0.3, -0.2, 4e-4, 3e-4, 1e-4, 500.0};
  for (int trial = 0; trial < 300; ++trial) {
    const double alpha = random.uniform(0.01, 0.4);
    const double beta = random.uniform(0.01, 0.4);
    const double budget = random.uniform(0.0, 150.0);
    const Split split = split_for_budget(budget, alpha, beta, fit);
    const double spent = alpha * split.region + beta * split.edge;
    EXPECT_GE(split.region, 0);
    EXPECT_GE(split.edge, 0);
    EXPECT_LE(spent, budget + 1e-6);
    EXPECT_GT(spent, budget - alpha - beta - 1e-6);
  }
}

TEST(SplitForBudget, NothingFitsIntoNoTime) {
  EXPECT_EQ(split_for_budget(0.0, 0.1, 0.1, {}).total(), 0);
  EXPECT_EQ(split_for_budget(0.0, 0.1, 0.1, {}).region_share(), 1.0);
}

TEST(DefaultFit, MoreSearchReducesTheError) {
  EXPECT_LT(default_fit()(200.0, 0.0), default_fit()(0.0, 0.0));
}

TEST(MeasureCost, DividesTheClockByTheEvaluations) {
  const Model model = make_model(Shape{});
  const auto backend = make_scalar_backend();
  double now = 0.0;
  Random random(1);
  // A clock that is read once before and once after each pass of 50 evaluations.
  const EvaluationCost cost =
      measure_cost(*backend, model, Camera{}.scaled_to(80, 60), 3, random, [&] { return now += 0.5; });
  EXPECT_NEAR(cost.region_ms, 10.0, 1e-9);
  EXPECT_NEAR(cost.edge_ms, 10.0, 1e-9);
  EXPECT_EQ(cost.width, 80);
}

TEST(FrameOfModel, TheModelFitsItsOwnFrame) {
  const Model model = make_model(Shape{});
  const auto backend = make_scalar_backend();
  Random random(2);
  const std::vector<Pose> poses = typical_poses(2, random);
  const PreparedFrame frame = frame_of_model(model, poses[0], Camera{}.scaled_to(160, 120));
  std::vector<Score> scores(2);
  backend->evaluate(frame, model, poses, Reduction::all, scores);
  EXPECT_EQ(scores[0].region(), 0.0);
  EXPECT_NEAR(scores[0].contour(), 0.0, 1e-6);
  EXPECT_GT(scores[1].region(), 0.0);
  EXPECT_GT(scores[1].contour(), 0.0);
}

}  // namespace
}  // namespace telemime
