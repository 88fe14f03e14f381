// SPDX-License-Identifier: Apache-2.0
#include "telemime/search/budget.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "telemime/core/errors.h"
#include "telemime/core/scratch_folder.h"

namespace telemime {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<ErrorSample> grid_of(const QuadraticFit& truth) {
  std::vector<ErrorSample> samples;
  for (const double x : {0.0, 50.0, 100.0, 200.0, 350.0, 500.0}) {
    for (const double y : {0.0, 50.0, 200.0, 500.0}) {
      samples.push_back({x, y, truth(x, y)});
    }
  }
  return samples;
}

TEST(QuadraticFit, FindsTheQuadraticThatMadeTheSamples) {
  const QuadraticFit truth{120.0, -0.3, -0.2, 4e-4, 3e-4, 2e-4, kInfinity};
  const QuadraticFit fit = fit_quadratic(grid_of(truth));
  EXPECT_NEAR(fit.a, truth.a, 1e-8);
  EXPECT_NEAR(fit.b, truth.b, 1e-10);
  EXPECT_NEAR(fit.c, truth.c, 1e-10);
  EXPECT_NEAR(fit.d, truth.d, 1e-12);
  EXPECT_NEAR(fit.f, truth.f, 1e-12);
  EXPECT_NEAR(fit.g, truth.g, 1e-12);
  EXPECT_EQ(fit.limit, 500.0);
}

TEST(QuadraticFit, ResidualsAreOrthogonalToEveryTerm) {
  std::vector<ErrorSample> samples = grid_of({100.0, -0.2, -0.1, 3e-4, 2e-4, 1e-4, kInfinity});
  Random random(5);
  for (ErrorSample& s : samples) {
    s.z += random.normal(0.0, 3.0);
  }
  const QuadraticFit fit = fit_quadratic(samples);
  double one = 0.0;
  double along_x = 0.0;
  double across = 0.0;
  for (const ErrorSample& s : samples) {
    const double residual = s.z - fit(s.x, s.y);
    one += residual;
    along_x += residual * s.x;
    across += residual * s.x * s.y;
  }
  EXPECT_NEAR(one, 0.0, 1e-6);
  EXPECT_NEAR(along_x, 0.0, 1e-4);
  EXPECT_NEAR(across, 0.0, 1e-2);
}

TEST(QuadraticFit, RefusesSamplesThatDoNotDetermineIt) {
  const std::vector<ErrorSample> line(20, {100.0, 100.0, 5.0});
  EXPECT_THROW(fit_quadratic(line), Error);
  EXPECT_THROW(fit_quadratic(std::vector<ErrorSample>(5)), Error);
}

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

class TuningFile : public ::testing::Test {
 protected:
  void write(const std::string& text) const { std::ofstream(file_) << text; }
  ScratchFolder folder_;
  std::filesystem::path file_ = folder_.file("tuning.json");
};

TEST_F(TuningFile, ReadsWhatWasWritten) {
  Tuning tuning;
  tuning.fit = {120.0, -0.3, -0.2, 4e-4, 3e-4, 2e-4, 500.0};
  tuning.costs = {{160, 120, 0.02, 0.03}, {320, 240, 0.05, 0.06}};
  write(tuning_json(tuning, 10.0));
  const Tuning read = read_tuning(file_);
  EXPECT_EQ(read.fit.g, tuning.fit.g);
  EXPECT_EQ(read.fit.limit, 500.0);
  ASSERT_EQ(read.costs.size(), 2U);
  EXPECT_EQ(read.cost_at(160, 120).edge_ms, 0.03);
  EXPECT_EQ(read.cost_at(640, 480).width, 320);
}

TEST_F(TuningFile, SaysWhatIsWrong) {
  EXPECT_THROW(read_tuning(file_), Error);
  write("{\"fit\": 3}");
  EXPECT_THROW(read_tuning(file_), Error);
  write("not json");
  EXPECT_THROW(read_tuning(file_), Error);
  EXPECT_THROW(Tuning{}.cost_at(160, 120), Error);
}

TEST(DefaultFit, IsTheOneInTheDataFolder) {
  const Tuning file = read_tuning(std::string(TELEMIME_SOURCE_DIR) + "/data/budget.json");
  const QuadraticFit fit = default_fit();
  EXPECT_EQ(fit.a, file.fit.a);
  EXPECT_EQ(fit.g, file.fit.g);
  EXPECT_EQ(fit.limit, file.fit.limit);
  // More search must reduce the error, or there would be nothing to divide.
  EXPECT_LT(fit(200.0, 0.0), fit(0.0, 0.0));
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
