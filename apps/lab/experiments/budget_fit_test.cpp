// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/budget_fit.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

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

class FitFile : public ::testing::Test {
 protected:
  void write(const std::string& text) const { std::ofstream(file_) << text; }
  ScratchFolder folder_;
  std::filesystem::path file_ = folder_.file("tuning.json");
};

TEST_F(FitFile, ReadsWhatWasWritten) {
  const QuadraticFit fit = {120.0, -0.3, -0.2, 4e-4, 3e-4, 2e-4, 500.0};
  const std::vector<EvaluationCost> costs = {{160, 120, 0.02, 0.03}, {320, 240, 0.05, 0.06}};
  const std::string text = tuning_json(fit, costs, 10.0);
  EXPECT_NE(text.find("\"beta_ms\": 0.06"), std::string::npos);
  EXPECT_NE(text.find("\"edge_iterations\""), std::string::npos);
  write(text);
  EXPECT_EQ(read_fit(file_).g, fit.g);
  EXPECT_EQ(read_fit(file_).limit, 500.0);
}

TEST_F(FitFile, RefusesOthers) {
  EXPECT_THROW(read_fit(file_), Error);
  for (const char* const text : {"{\"fit\": 3}", "not json", ""}) {
    write(text);
    EXPECT_THROW(read_fit(file_), Error) << text;
  }
}

TEST(DefaultFit, IsTheOneInTheDataFolder) {
  const QuadraticFit file = read_fit(std::string(TELEMIME_SOURCE_DIR) + "/data/budget.json");
  EXPECT_EQ(default_fit().a, file.a);
  EXPECT_EQ(default_fit().g, file.g);
  EXPECT_EQ(default_fit().limit, file.limit);
}

}  // namespace
}  // namespace telemime
