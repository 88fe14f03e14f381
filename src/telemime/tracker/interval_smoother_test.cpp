// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracker/interval_smoother.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <functional>

#include "telemime/core/random.h"

namespace telemime {
namespace {

constexpr double kStep = 0.04;
constexpr IntervalModel kNormal = {.noise = 0.03, .motion = 1.0, .sudden = 1e9};
constexpr IntervalModel kStudent = {.noise = 0.03, .motion = 1.0, .sudden = 2.0};

std::vector<IntervalSample<1>> samples_of(int count, double noise, Random& random,
                                          const std::function<double(int)>& truth) {
  std::vector<IntervalSample<1>> samples;
  for (int t = 0; t < count; ++t) {
    IntervalSample<1> sample;
    sample.value[0] = truth(t) + random.normal(0.0, noise);
    sample.step = kStep;
    samples.push_back(sample);
  }
  return samples;
}

// Each sample smoothed in turn with `ahead` samples after it.
std::vector<double> smoothed(const IntervalModel& model, const std::vector<IntervalSample<1>>& samples,
                             std::size_t ahead) {
  std::optional<IntervalState<1>> state;
  std::vector<double> result;
  for (std::size_t t = 0; t < samples.size(); ++t) {
    const std::size_t count = std::min(samples.size() - t, ahead + 1);
    result.push_back(smoothed_first<1>(model, std::span(samples).subspan(t, count), state)[0]);
  }
  return result;
}

// The same by least squares over all values and velocities at once.
Eigen::VectorXd least_squares(const IntervalModel& model, const std::vector<IntervalSample<1>>& samples) {
  const auto count = static_cast<Eigen::Index>(samples.size());
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(2 * count, 2 * count);
  Eigen::VectorXd vector = Eigen::VectorXd::Zero(2 * count);
  const double noise = model.noise * model.noise, density = model.motion * model.motion;
  for (Eigen::Index t = 0; t < count; ++t) {
    const IntervalSample<1>& sample = samples[static_cast<std::size_t>(t)];
    information(2 * t, 2 * t) += 1.0 / (noise * sample.ratio);
    vector[2 * t] += sample.value[0] / (noise * sample.ratio);
    if (t == 0) {
      information(1, 1) += 1.0 / density;
      continue;
    }
    Eigen::Matrix<double, 2, 4> change;
    change << -interval::transition(sample.step), Eigen::Matrix2d::Identity();
    const Eigen::Matrix2d weight = (density * interval::acceleration(sample.step)).inverse();
    information.block<4, 4>(2 * t - 2, 2 * t - 2) += change.transpose() * weight * change;
  }
  return information.ldlt().solve(vector);
}

TEST(IntervalSmoother, IsLeastSquaresWithNormalAccelerations) {
  Random random(1);
  auto samples = samples_of(40, 0.05, random, [](int t) { return std::sin(0.2 * t); });
  for (std::size_t t = 0; t < samples.size(); ++t) {
    samples[t].step = t % 3 == 0 ? 0.033 : 0.05;
    samples[t].ratio = t % 7 == 0 ? 4.0 : 1.0;
  }
  const auto result = smoothed(kNormal, samples, samples.size());
  const Eigen::VectorXd expected = least_squares(kNormal, samples);
  for (std::size_t t = 0; t < samples.size(); ++t) {
    EXPECT_NEAR(result[t], expected[static_cast<Eigen::Index>(2 * t)], 1e-9) << t;
  }
}

TEST(IntervalSmoother, SteadyMotionPassesUnchanged) {
  Random random(1);
  const auto truth = [](int t) { return 0.1 * t - 1.0; };
  const auto samples = samples_of(60, 0.0, random, truth);
  const auto result = smoothed(kStudent, samples, 12);
  for (std::size_t t = 15; t < samples.size(); ++t) {
    EXPECT_NEAR(result[t], truth(static_cast<int>(t)), 1e-3) << t;
  }
}

TEST(IntervalSmoother, SuddenMotionIsFollowedAndRestIsSteady) {
  Random random(2);
  // Rest, a quarter of a turn in three frames, rest.
  constexpr double kEachFrame = 0.5;
  const auto truth = [](int t) { return kEachFrame * std::clamp(t - 50.0, 0.0, 3.0); };
  const auto samples = samples_of(100, kStudent.noise, random, truth);
  const auto error = [&](const IntervalModel& model, std::size_t from, std::size_t until) {
    const auto result = smoothed(model, samples, 12);
    double worst = 0.0;
    for (std::size_t t = from; t < until; ++t) {
      worst = std::max(worst, std::abs(result[t] - truth(static_cast<int>(t))));
    }
    return worst;
  };
  EXPECT_LT(error(kStudent, 15, 45), 1.2 * kStudent.noise) << "the largest noise of 30 is about twice that";
  EXPECT_LT(error(kStudent, 46, 60), 0.5 * kEachFrame) << "late or early by less than half a frame";
  EXPECT_GT(error(kNormal, 46, 60), 0.6 * kEachFrame) << "which is not so with normal accelerations";
}

TEST(IntervalSmoother, SeveralNumbersAreSmoothedTogether) {
  Random random(3);
  std::vector<IntervalSample<3>> three;
  std::vector<IntervalSample<1>> one;
  for (int t = 0; t < 20; ++t) {
    IntervalSample<1> sample;
    sample.value[0] = random.normal(0.0, 0.1);
    sample.step = kStep;
    one.push_back(sample);
    IntervalSample<3> same;
    same.value.setConstant(sample.value[0]);
    same.step = kStep;
    three.push_back(same);
  }
  std::optional<IntervalState<1>> before_one;
  std::optional<IntervalState<3>> before_three;
  const double expected = smoothed_first<1>(kNormal, one, before_one)[0];
  const Eigen::RowVector3d result = smoothed_first<3>(kNormal, three, before_three);
  EXPECT_NEAR((result - Eigen::RowVector3d::Constant(expected)).norm(), 0.0, 1e-9);
}

}  // namespace
}  // namespace telemime
