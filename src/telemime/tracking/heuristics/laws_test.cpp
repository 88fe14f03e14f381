// SPDX-License-Identifier: Apache-2.0
// Laws for every heuristic of the table, alone and with all others, in the thesis's filter and in the default
// one.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>

#include "telemime/likelihood/testing_landmarks.h"
#include "telemime/tracking/heuristics/all.h"
#include "telemime/tracking/particle_filter.h"
#include "telemime/tracking/testing_scene.h"

namespace telemime {
namespace {

using testing_scene::both_arms_seen;
using testing_scene::kDegree;
using testing_scene::Scene;

constexpr int kParticles = 100;
constexpr int kFrames = 4;

struct Case {
  std::string name;
  FilterConfig config;
};

std::vector<Case> cases() {
  std::vector<std::string> lists = {"", heuristic_names()};
  for (const Heuristic& h : kHeuristics) {
    lists.emplace_back(h.name);
  }
  std::vector<Case> all;
  for (const std::string& list : lists) {
    FilterConfig thesis = reference_filter(list);
    thesis.particles = kParticles;
    FilterConfig ours;
    ours.heuristics = list;
    ours.particles = kParticles;
    ours.mode_least = 50;
    ours.second_evaluations = 30;
    ours.turn_evaluations = 30;
    ours.walk_evaluations = 60;
    ours.landmark_share = 1.0;
    all.push_back({"thesis: " + list, thesis});
    all.push_back({"ours: " + list, ours});
  }
  return all;
}

// The left arm rises from frame to frame.
std::vector<PreparedFrame> make_frames(bool landmarks) {
  const Scene scene;
  std::vector<PreparedFrame> list;
  for (int i = 0; i < kFrames; ++i) {
    Pose pose = both_arms_seen();
    pose[Angle::l_shoulder_abduct] += 5 * i * kDegree;
    list.push_back(frame_of_model(scene.model, pose, scene.camera));
    if (landmarks) {
      list.back().landmarks = testing_landmarks::perfect_landmarks(scene.model.body, pose, scene.camera);
    }
  }
  return list;
}

const std::vector<PreparedFrame>& frames(bool landmarks = true) {
  static const std::array<std::vector<PreparedFrame>, 2> all = {make_frames(false), make_frames(true)};
  return all[landmarks ? 1 : 0];
}

struct Step {
  FilterResult result;
  std::vector<Particle> particles;
};

std::vector<Step> run(const FilterConfig& config, int threads, std::uint64_t seed, bool landmarks = true) {
  static const Scene scene;
  Evaluators evaluators("simd", threads);
  testing_scene::RunningFilter filter(scene, config, evaluators, seed);
  Pose start = both_arms_seen();
  start[Angle::root_torsion] += 0.15;
  filter.start(start);
  std::vector<Step> steps;
  for (const PreparedFrame& frame : frames(landmarks)) {
    const FilterResult result = filter.step({.frame = frame, .model = scene.model, .velocity = 0.5});
    steps.push_back({result, filter.particles()});
  }
  return steps;
}

::testing::AssertionResult same(const std::vector<Step>& a, const std::vector<Step>& b) {
  for (std::size_t t = 0; t < a.size(); ++t) {
    const auto differs = [t](const std::string& what) {
      return ::testing::AssertionFailure() << what << " in frame " << t;
    };
    if (a[t].result.pose.vector() != b[t].result.pose.vector()) {
      return differs("the estimate");
    }
    if (a[t].result.evaluations != b[t].result.evaluations || a[t].result.moving != b[t].result.moving) {
      return differs("what was spent or moved");
    }
    if (a[t].particles.size() != b[t].particles.size()) {
      return differs("the number of particles");
    }
    for (std::size_t i = 0; i < a[t].particles.size(); ++i) {
      const Particle& p = a[t].particles[i];
      const Particle& q = b[t].particles[i];
      if (p.pose.vector() != q.pose.vector() || p.weight != q.weight || p.prior != q.prior ||
          p.log_likelihood != q.log_likelihood || p.score.region() != q.score.region() ||
          p.score.contour() != q.score.contour() || p.parent != q.parent || p.origin != q.origin) {
        return differs("particle " + std::to_string(i));
      }
    }
  }
  return ::testing::AssertionSuccess();
}

bool has_drawn(const std::vector<Step>& steps) {
  return std::any_of(steps.begin(), steps.end(), [](const Step& step) {
    return std::any_of(step.particles.begin(), step.particles.end(),
                       [](const Particle& p) { return p.origin == Origin::diffused; });
  });
}

TEST(FilterLaws, SameSeedSameParticlesForAnyThreads) {
  // Also on a machine with fewer cores.
  const tbb::global_control threads_there_are(tbb::global_control::max_allowed_parallelism, 4);
  int drawn = 0;
  for (const Case& c : cases()) {
    const std::vector<Step> one = run(c.config, 1, 7);
    for (const int threads : {1, 2, 3, 4}) {
      EXPECT_TRUE(same(one, run(c.config, threads, 7))) << c.name << " on " << threads;
    }
    if (has_drawn(one)) {  // a single family that is searched needs no random draws
      ++drawn;
      EXPECT_FALSE(same(one, run(c.config, 1, 8))) << c.name << ": the seed is used";
    }
  }
  EXPECT_GE(drawn, 12);
}

TEST(FilterLaws, ParticlesAreInsideTheLimitsAndMeasured) {
  const JointLimits limits = anatomical_limits();
  for (const Case& c : cases()) {
    const std::vector<Step> steps = run(c.config, 1, 3);
    for (const Step& step : steps) {
      EXPECT_TRUE(limits.contains(step.result.pose)) << c.name;
      for (const Particle& p : step.particles) {
        ASSERT_TRUE(p.pose.vector().allFinite()) << c.name;
        ASSERT_TRUE(limits.contains(p.pose)) << c.name;
        ASSERT_TRUE(p.measured && std::isfinite(p.log_likelihood)) << c.name;
        ASSERT_NE(p.origin, Origin::start) << c.name;
      }
    }
  }
}

TEST(FilterLaws, WeightsAreNormalisedAndParentsExist) {
  for (const Case& c : cases()) {
    std::size_t before = 1;
    for (const Step& step : run(c.config, 1, 4)) {
      double sum = 0.0;
      for (const Particle& p : step.particles) {
        ASSERT_GE(p.weight, 0.0) << c.name;
        ASSERT_GT(p.prior, 0.0) << c.name;
        ASSERT_GE(p.parent, 0) << c.name;
        ASSERT_LT(p.parent, static_cast<int>(before)) << c.name;
        sum += p.weight;
      }
      EXPECT_NEAR(sum, 1.0, 1e-9) << c.name;
      EXPECT_NEAR(step.result.effective_particles, effective_sample_size(step.particles), 1e-9) << c.name;
      before = step.particles.size();
    }
  }
}

TEST(FilterLaws, TheNumberOfParticlesIsKept) {
  for (const Case& c : cases()) {
    // In the default filter each searched family costs at least mode_least; each turned trunk and each pose
    // from landmarks add their own.
    const int flips = 15 * c.config.flip_candidates;
    const int searched = c.config.blocks ? c.config.modes * c.config.mode_least : 0;
    const bool turns = c.config.heuristics.find("turn") != std::string::npos;
    // One trunk at random and two with a long search, each from the better of two starts.
    const int usual = c.config.turn_evaluations;
    const int thorough = std::max(usual, std::min(c.config.walk_evaluations, kParticles / 2));
    const int turned = turns ? usual + 2 * thorough + 3 * 2 : 0;
    const bool lands = c.config.heuristics.find("landmarks") != std::string::npos;
    constexpr int kProposed = 8;
    const int landed = lands ? kProposed + c.config.landmark_searches * c.config.landmark_evaluations : 0;
    const int most = kParticles + flips + searched + turned + landed;
    const std::size_t added = (turns ? 3 : 0) + (lands ? kProposed : 0);
    for (const Step& step : run(c.config, 1, 5)) {
      ASSERT_FALSE(step.particles.empty()) << c.name;
      if (!c.config.blocks && added == 0) {
        EXPECT_EQ(step.particles.size(), static_cast<std::size_t>(kParticles)) << c.name;
      }
      EXPECT_LE(step.particles.size(), static_cast<std::size_t>(kParticles) + added) << c.name;
      EXPECT_LE(step.result.evaluations, most) << c.name;
      EXPECT_GE(step.result.evaluations, kParticles / 2) << c.name;
    }
  }
}

TEST(FilterLaws, ConvergedSimplexesKeepTheParticleCount) {
  // Seven numbers of one arm and hundreds of evaluations for them.
  for (const std::string list : {"wd,hpm,lo", "wd,hpm,ee,lo", "wd,hpm,ee,lo,kf"}) {
    FilterConfig config = reference_filter(list);
    config.particles = 900;
    for (const Step& step : run(config, 1, 2)) {
      EXPECT_EQ(step.particles.size(), 900U) << list;
    }
  }
}

TEST(FilterLaws, EveryHeuristicChangesSomething) {
  for (const Heuristic& h : kHeuristics) {
    const std::string name(h.name);
    FilterConfig with = reference_filter("wd," + name);
    FilterConfig without = reference_filter("wd");
    if (name == "wd") {
      without = reference_filter("");
    }
    with.particles = without.particles = kParticles;
    // Turned trunks are tried where no landmarks show the trunk.
    const bool landmarks = name != "turn";
    EXPECT_FALSE(same(run(with, 1, 6, landmarks), run(without, 1, 6, landmarks))) << name;
  }
}

}  // namespace
}  // namespace telemime
