// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracking/particle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "telemime/tracking/testing_scene.h"

namespace telemime {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Priors and log likelihoods.
std::vector<Particle> unweighted(const std::vector<std::pair<double, double>>& values) {
  std::vector<Particle> particles;
  for (const auto& [prior, log_likelihood] : values) {
    Particle p;
    p.prior = prior;
    p.log_likelihood = log_likelihood;
    particles.push_back(p);
  }
  return particles;
}

std::vector<double> weighed(const std::vector<std::pair<double, double>>& values) {
  std::vector<Particle> particles = unweighted(values);
  weigh(particles);
  std::vector<double> weights;
  for (const Particle& p : particles) {
    weights.push_back(p.weight);
  }
  return weights;
}

TEST(EffectiveSampleSize, CountsTheParticlesThatCarry) {
  std::vector<Particle> particles(8);
  EXPECT_EQ(effective_sample_size(particles), 0.0) << "no weights";
  EXPECT_EQ(effective_sample_size({}), 0.0);
  for (Particle& p : particles) {
    p.weight = 1.0 / 8.0;
  }
  EXPECT_DOUBLE_EQ(effective_sample_size(particles), 8.0);
  for (Particle& p : particles) {
    p.weight = 0.0;
  }
  particles[3].weight = 1.0;
  EXPECT_DOUBLE_EQ(effective_sample_size(particles), 1.0);
  particles[3].weight = particles[5].weight = 0.5;
  EXPECT_DOUBLE_EQ(effective_sample_size(particles), 2.0);
}

TEST(MeanPose, OfTrunksThatAreTurnedAwayIsTurnedAway) {
  std::vector<Particle> particles(2);
  particles[0].weight = 0.75;
  particles[0].pose[Angle::root_torsion] = 3.1;
  particles[1].weight = 0.25;
  particles[1].pose[Angle::root_torsion] = -3.1;
  particles[1].pose[Angle::root_roll] = 0.4;
  const Pose mean = mean_pose(particles);
  EXPECT_NEAR(mean[Angle::root_torsion], 3.1 + 0.25 * (2.0 * std::numbers::pi - 6.2), 1e-12);
  EXPECT_NEAR(mean[Angle::root_roll], 0.1, 1e-12);
}

TEST(Weigh, IsPriorTimesLikelihoodNormalised) {
  // 0.2 * 2, 0.3 * 4, 0.5 * 1 of 2.1.
  const auto w = weighed({{0.2, std::log(2.0)}, {0.3, std::log(4.0)}, {0.5, 0.0}});
  EXPECT_NEAR(w[0], 0.4 / 2.1, 1e-12);
  EXPECT_NEAR(w[1], 1.2 / 2.1, 1e-12);
  EXPECT_NEAR(w[2], 0.5 / 2.1, 1e-12);
}

TEST(Weigh, KeepsDifferencesOfTinyAndHugeLikelihoods) {
  for (const double level : {-1e6, 0.0, 1e6}) {
    const auto w = weighed({{1.0, level}, {1.0, level + std::log(3.0)}});
    EXPECT_NEAR(w[0], 0.25, 1e-9) << level;
    EXPECT_NEAR(w[1], 0.75, 1e-9) << level;
  }
}

TEST(Weigh, TheImpossibleWeighsNothing) {
  EXPECT_EQ(weighed({{0.5, -kInfinity}, {0.5, -3.0}}), (std::vector<double>{0.0, 1.0}));
  EXPECT_EQ(weighed({{0.0, 100.0}, {0.5, -3.0}}), (std::vector<double>{0.0, 1.0}));
}

TEST(Weigh, WhenNothingIsPossibleThePriorsStay) {
  EXPECT_EQ(weighed({{1.0, -kInfinity}, {3.0, -kInfinity}}), (std::vector<double>{0.25, 0.75}));
  EXPECT_EQ(weighed({{0.0, -kInfinity}, {0.0, 1.0}}), (std::vector<double>{0.5, 0.5}));
}

TEST(Heaviest, IsTheFirstOfEquals) {
  std::vector<Particle> particles(5);
  EXPECT_EQ(heaviest(particles), 0U);
  particles[2].weight = particles[4].weight = 0.5;
  EXPECT_EQ(heaviest(particles), 2U);
  particles[4].weight = 0.6;
  EXPECT_EQ(heaviest(particles), 4U);
}

TEST(MeanPose, IsTheWeightedMeanOfTheNumbers) {
  Pose a;
  Pose b;
  a.root = {0.0, 1.0, 2.0};
  b.root = {1.0, 1.0, 4.0};
  a[Angle::neck_tilt] = 0.2;
  b[Angle::neck_tilt] = -0.2;
  const std::vector<Particle> particles = {testing_scene::particle(a, 0.25),
                                           testing_scene::particle(b, 0.75)};
  const Pose mean = mean_pose(particles);
  EXPECT_LT((mean.root - Eigen::Vector3d(0.75, 1.0, 3.5)).norm(), 1e-12);
  EXPECT_NEAR(mean[Angle::neck_tilt], -0.1, 1e-12);
  EXPECT_EQ(mean[Angle::l_elbow_flexion], 0.0);
}

}  // namespace
}  // namespace telemime
