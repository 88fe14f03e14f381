// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracking/context.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <set>
#include <stdexcept>
#include <thread>

#include "telemime/body/interpenetration.h"
#include "telemime/tracking/testing_scene.h"

namespace telemime {
namespace {

using testing_scene::both_arms_seen;
using testing_scene::kDegree;
using testing_scene::particle;
using testing_scene::Scene;

Score score_of(double region, double contour) {
  Score score;
  score.costs[cue::kRegion] = region;
  score.costs[cue::kContour] = contour;
  return score;
}

// Without terms that do not depend on the image.
Scene image_alone() {
  Scene scene;
  scene.config.invalid = scene.config.natural = scene.config.temporal = 0.0;
  scene.config.trust = 1.0;
  scene.numbers.sigma[cue::kRegion] = 0.1;
  scene.numbers.sigma[cue::kContour] = 0.05;  // 6 px of 120
  return scene;
}

TEST(LogLikelihood, IsThatOfTwoGaussians) {
  Scene scene = image_alone();
  EXPECT_NEAR(log_likelihood(scene.context(), both_arms_seen(), score_of(0.3, 12.0), 0), -0.5 * (9.0 + 4.0),
              1e-12);
  EXPECT_EQ(log_likelihood(scene.context(), both_arms_seen(), score_of(0.0, 0.0), 0), 0.0);
  scene.config.trust = 0.1;
  EXPECT_NEAR(log_likelihood(scene.context(), both_arms_seen(), score_of(0.3, 12.0), 0), -0.05 * 13.0, 1e-12);
}

TEST(LogLikelihood, UnknownNoiseCountsByRatio) {
  constexpr double kUsual = 100.0;
  constexpr double kStep = 1e-4;
  const auto derivative = [&](double square) {
    return (square_of_unknown_noise(square + kStep, kUsual) - square_of_unknown_noise(square, kUsual)) /
           kStep;
  };
  EXPECT_EQ(square_of_unknown_noise(0.0, kUsual), 0.0);
  EXPECT_NEAR(derivative(kUsual), 1.0, 1e-5);
  EXPECT_GT(derivative(0.5 * kUsual), derivative(kUsual));
  // Far beyond, it is the ratio of two costs that counts, however noisy the picture is.
  const auto ratio = [&](double noise) {
    return square_of_unknown_noise(1.2 * noise, kUsual) - square_of_unknown_noise(noise, kUsual);
  };
  EXPECT_NEAR(ratio(1e6), ratio(1e7), 1e-2);
}

TEST(LogLikelihood, RegionsCountLessInANoisyRoom) {
  Scene scene = image_alone();
  scene.numbers.sigma[cue::kRegion] = 0.01;
  scene.numbers.usual[cue::kRegion] = 0.1;
  const auto gain = [&](double better, double worse) {
    return log_likelihood(scene.context(), both_arms_seen(), score_of(better, 0.0), 0) -
           log_likelihood(scene.context(), both_arms_seen(), score_of(worse, 0.0), 0);
  };
  // Colours and outlines alone: equation 4.12 as it is.
  EXPECT_GT(gain(0.50, 0.51), gain(0.10, 0.11));
  scene.frame.landmarks.emplace();
  EXPECT_LT(gain(0.50, 0.51), 0.5 * gain(0.10, 0.11));
  EXPECT_GT(gain(0.50, 0.51), 0.0);
}

TEST(LogLikelihood, CountsAddedAndDisabledCues) {
  CueTable cues;
  cues.add({.name = "constant",
            .what = "always 1",
            .unit = CueUnit::pixels,
            .sigma = 0.005,
            .cost = [](const CueInput&) { return 1.2; }});
  Scene scene = image_alone();
  scene.numbers.sigma[kCues.size()] = load_filter_model("", cues).sigma[kCues.size()];
  Score score = score_of(0.3, 12.0);
  score.costs[kCues.size()] = 1.2;  // 2 sigma of a picture 120 pixels wide
  EXPECT_NEAR(log_likelihood(scene.context(), both_arms_seen(), score, 0), -0.5 * (9.0 + 4.0), 1e-12);
  scene.evaluators = Evaluators("scalar", 1, cues);
  EXPECT_NEAR(log_likelihood(scene.context(), both_arms_seen(), score, 0), -0.5 * (9.0 + 4.0 + 4.0), 1e-12);
  cues.enable(cue::kRegion, false);
  scene.evaluators = Evaluators("scalar", 1, cues);
  EXPECT_NEAR(log_likelihood(scene.context(), both_arms_seen(), score, 0), -0.5 * (4.0 + 4.0), 1e-12);
}

TEST(LogLikelihood, TakesOffWhatIsKnownWithoutTheImage) {
  Scene scene = image_alone();
  Pose inside = both_arms_seen();  // the left hand in the chest
  set_arm_angles(inside, Side::left, {20 * kDegree, -60 * kDegree, -10 * kDegree, -100 * kDegree});
  const Kinematics k = forward_kinematics(scene.model.body, inside);
  const double depth = interpenetration(scene.model.body, k);
  ASSERT_GT(depth, 0.0);
  const Score none = score_of(0.0, 0.0);
  scene.config.invalid = 400.0;
  EXPECT_NEAR(log_likelihood(scene.context(), inside, none, 0), -400.0 * depth, 1e-9);
  scene.config.invalid = 0.0;
  scene.config.natural = 3.0;
  scene.heading = 0.4;
  EXPECT_NEAR(log_likelihood(scene.context(), inside, none, 0),
              -3.0 * natural_cost(scene.model.body, inside, k, 0.4), 1e-9);
  scene.config.natural = 0.0;
  scene.config.temporal = 2.0;
  EXPECT_NEAR(log_likelihood(scene.context(), inside, none, 0),
              -2.0 * distance_from_predicted(k, scene.joints(scene.predicted)), 1e-9);
  EXPECT_EQ(log_likelihood(scene.context(), scene.predicted, none, 0), 0.0);
  // Each hypothesis is compared with its own past.
  FilterContext two = scene.context();
  two.predicted_joints.push_back(k.joints);
  EXPECT_EQ(log_likelihood(two, inside, none, 1), 0.0);
}

TEST(Measure, GivesEachItsOwnScoreAndLeavesTheOthers) {
  Scene scene = image_alone();
  std::vector<Particle> particles;
  for (int i = 0; i < 7; ++i) {
    Pose pose = both_arms_seen();
    pose[Angle::l_shoulder_abduct] += 3.0 * i * kDegree;
    particles.push_back(particle(pose, 1.0));
  }
  particles[3].measured = true;
  particles[3].log_likelihood = 5.0;
  const FilterContext context = scene.context();
  measure(context, particles);
  const auto backend = make_scalar_backend();
  for (std::size_t i = 0; i < particles.size(); ++i) {
    EXPECT_TRUE(particles[i].measured);
    if (i == 3) {
      EXPECT_EQ(particles[i].log_likelihood, 5.0);
      continue;
    }
    Score alone;
    backend->evaluate(scene.frame, scene.model, {&particles[i].pose, 1}, Reduction::all, {&alone, 1});
    EXPECT_EQ(particles[i].score.region(), alone.region()) << i;
    EXPECT_EQ(particles[i].score.contour(), alone.contour()) << i;
    EXPECT_EQ(particles[i].log_likelihood, log_likelihood(context, particles[i].pose, alone, 0)) << i;
  }
  EXPECT_GT(particles[0].log_likelihood, particles[6].log_likelihood);
}

TEST(FilterContext, EveryPurposeAndParticleDrawsOnItsOwn) {
  Scene scene;
  std::set<std::uint64_t> first;
  for (const std::uint64_t purpose :
       {purpose::kResampling, purpose::kDiffusion, purpose::kSimplex, purpose::kHeadingSearch}) {
    for (std::uint64_t index = 0; index < 500; ++index) {
      Random random = scene.context(3).random(purpose, index);
      EXPECT_TRUE(first.insert(random.bits()).second) << purpose << " " << index;
    }
  }
  Random again = scene.context(3).random(purpose::kSimplex, 17);
  EXPECT_EQ(first.count(again.bits()), 1U) << "the same again";
  Random other = scene.context(4).random(purpose::kSimplex, 17);
  EXPECT_EQ(first.count(other.bits()), 0U) << "of another frame";
}

TEST(Evaluators, DoEachPieceOfWorkOnce) {
  for (const int threads : {1, 3}) {
    Evaluators evaluators("scalar", threads);
    std::vector<std::atomic<int>> done(200);
    evaluators.each(done.size(), [&](std::size_t i, Backend&) { ++done[i]; });
    for (const auto& times : done) {
      EXPECT_EQ(times, 1);
    }
    evaluators.each(0, [&](std::size_t, Backend&) { ADD_FAILURE(); });
  }
}

TEST(Evaluators, LetExceptionsOut) {
  Evaluators evaluators("simd", 2);
  constexpr std::size_t kCount = 1000;
  std::atomic<std::size_t> calls = 0;
  std::atomic<bool> thrown = false;
  EXPECT_THROW(evaluators.each(kCount,
                               [&](std::size_t i, Backend&) {
                                 ++calls;
                                 if (i == 0) {
                                   thrown = true;
                                   throw std::out_of_range("the first");
                                 }
                                 // The other thread goes on slowly once the exception is on its way.
                                 while (!thrown) {
                                   std::this_thread::yield();
                                 }
                                 std::this_thread::sleep_for(std::chrono::milliseconds(2));
                               }),
               std::out_of_range);
  EXPECT_LT(calls, kCount / 2);
  EXPECT_THROW(Evaluators("abacus", 1), std::runtime_error);
}

}  // namespace
}  // namespace telemime
