// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracking/particle_filter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <set>

#include "telemime/body/arm_flips.h"
#include "telemime/core/errors.h"
#include "telemime/core/scratch_folder.h"
#include "telemime/tracking/testing_scene.h"

namespace telemime {
namespace {

using testing_scene::both_arms_seen;
using testing_scene::kDegree;
using testing_scene::RunningFilter;
using testing_scene::Scene;

FilterConfig thesis(const std::string& heuristics, int particles) {
  FilterConfig config = reference_filter(heuristics);
  config.particles = particles;
  return config;
}

RunningFilter make_filter(Scene& scene, const FilterConfig& config, std::uint64_t seed = 1) {
  return {scene, config, scene.evaluators, seed};
}

// The same, started at the pose that the scene shows at first.
RunningFilter started(Scene& scene, const FilterConfig& config) {
  RunningFilter filter = make_filter(scene, config);
  filter.start(both_arms_seen());
  return filter;
}

StepInput input(const Scene& scene, double velocity) {
  return {.frame = scene.frame, .model = scene.model, .velocity = velocity};
}

const Particle& best_of(const RunningFilter& filter) {
  return filter.particles()[heaviest(filter.particles())];
}

double left_wrist_error(const Scene& scene, const Pose& a, const Pose& b) {
  return (scene.joints(a)[Joint::l_wrist] - scene.joints(b)[Joint::l_wrist]).norm();
}

TEST(ParticleFilter, CondensationFollowsASlowlyRaisedArm) {
  // With the narrow likelihood and wide diffusion learned from tracked sequences, so few particles would soon
  // lose the arm.
  const ScratchFolder folder;
  FilterModel numbers = load_filter_model("");
  numbers.sigma[cue::kRegion] = 0.03;
  numbers.sigma[cue::kContour] = 0.004;
  numbers.change.head<3>().setConstant(0.005);
  numbers.change.segment<6>(3).setConstant(1.0 * kDegree);
  numbers.change.tail<14>().setConstant(4.0 * kDegree);
  std::ofstream(folder.file("wide.json")) << to_json_text(numbers, "wide");
  FilterConfig config = thesis("", 500);
  config.model = folder.file("wide.json");
  Scene scene;
  RunningFilter filter = make_filter(scene, config);
  Pose truth = both_arms_seen();
  filter.start(truth);
  double sum = 0.0;
  constexpr int kFrames = 40;
  for (int i = 0; i < kFrames; ++i) {
    truth[Angle::l_shoulder_abduct] += 1.5 * kDegree;
    scene.show(truth);
    const FilterResult found = filter.step(input(scene, 0.0));
    EXPECT_EQ(found.evaluations, 500);
    sum += left_wrist_error(scene, found.pose, truth);
  }
  EXPECT_GT(left_wrist_error(scene, both_arms_seen(), truth), 0.3) << "m, the whole way";
  EXPECT_LT(sum / kFrames, 0.13) << "m, mean over the frames";
}

TEST(ParticleFilter, SteppingBackKeepsTheHeading) {
  Scene scene;
  FilterConfig config;
  config.particles = config.mode_most = 300;
  RunningFilter filter = make_filter(scene, config);
  Pose truth = both_arms_seen();
  filter.start(truth);
  for (int i = 0; i < 20; ++i) {
    truth.root.z() += 0.03;  // m a frame
    scene.show(truth);
    const FilterResult found = filter.step(input(scene, 0.5));
    EXPECT_LT(std::abs(found.heading), 60 * kDegree) << i;
    EXPECT_LT(std::abs(found.pose[Angle::root_torsion]), 60 * kDegree) << i;
  }
}

TEST(ParticleFilter, WalkingTurnsTheHeading) {
  Scene scene;
  FilterConfig config;
  config.particles = config.mode_most = 300;
  for (const bool backward : {false, true}) {
    for (const double side : {-1.0, 1.0}) {
      RunningFilter filter = make_filter(scene, config);
      Pose truth = both_arms_seen();
      filter.start(truth, backward);
      double heading = 0.0;
      for (int i = 0; i < 12; ++i) {
        truth.root.x() += side * 0.03;
        scene.show(truth);
        heading = filter.step(input(scene, 0.5)).heading;
      }
      EXPECT_GT((backward ? -side : side) * heading, 30 * kDegree);
    }
  }
}

TEST(ParticleFilter, ParticlesSpreadWithTheRootOfTheTimeStep) {
  Scene scene;
  const auto spread = [&](double frames) {
    RunningFilter filter = started(scene, thesis("", 400));
    filter.step({.frame = scene.frame, .model = scene.model, .time_step = frames});
    double sum = 0.0;
    for (const Particle& p : filter.particles()) {
      const double way = p.pose.root.x() - both_arms_seen().root.x();
      sum += way * way;
    }
    return std::sqrt(sum / 400.0);
  };
  EXPECT_NEAR(spread(4.0) / spread(1.0), 2.0, 0.05);
}

TEST(ParticleFilter, TheEffortIsAShareOfTheEvaluations) {
  Scene scene;
  const auto evaluations = [&](double effort, const FilterConfig& config) {
    RunningFilter filter = started(scene, config);
    return filter.step({.frame = scene.frame, .model = scene.model, .velocity = 0.5, .effort = effort})
        .evaluations;
  };
  EXPECT_EQ(evaluations(0.5, thesis("", 400)), 200);
  const int whole = evaluations(1.0, FilterConfig());
  EXPECT_LT(evaluations(0.25, FilterConfig()), 0.4 * whole);
  Scene other;
  RunningFilter filter = started(other, FilterConfig());
  for (const double bad : {0.0, -1.0, 1.5, std::nan("")}) {
    const double bad_step = bad == 1.5 ? 0.0 : bad;
    EXPECT_THROW(filter.step({.frame = other.frame, .model = other.model, .effort = bad}), Error) << bad;
    EXPECT_THROW(filter.step({.frame = other.frame, .model = other.model, .time_step = bad_step}), Error)
        << bad_step;
  }
}

TEST(ParticleFilter, TheMeanOfTheParticlesIsScoredItself) {
  Scene scene;
  FilterConfig config = thesis("", 100);
  config.estimate = "mean";
  RunningFilter filter = started(scene, config);
  const FilterResult found = filter.step(input(scene, 0.0));
  EXPECT_EQ(found.pose.vector(), scene.limits.clamp(mean_pose(filter.particles())).vector());
  EXPECT_NE(found.pose.vector(), best_of(filter).pose.vector());
  Score score;
  scene.evaluators.evaluate(scene.frame, scene.model, {&found.pose, 1}, {&score, 1});
  EXPECT_EQ(found.score.region(), score.region());
  EXPECT_EQ(found.score.contour(), score.contour());
}

TEST(ParticleFilter, ChildrenOfOneParentDiffer) {
  Scene scene;
  RunningFilter filter = started(scene, thesis("", 100));
  filter.step(input(scene, 0.0));
  std::set<double> roots;
  for (const Particle& p : filter.particles()) {
    EXPECT_EQ(p.parent, 0);
    EXPECT_TRUE(roots.insert(p.pose.root.x()).second);
  }
}

TEST(ParticleFilter, KeepingTheBestNeverWorsensTheEstimate) {
  Scene scene;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    RunningFilter filter = make_filter(scene, thesis("wd", 60), seed);
    Pose start = both_arms_seen();
    start[Angle::l_elbow_flexion] -= 15 * kDegree;
    filter.start(start);
    double before = -std::numeric_limits<double>::infinity();
    bool kept = false;
    for (int i = 0; i < 15; ++i) {
      filter.step(input(scene, 0.0));
      const Particle& best = best_of(filter);
      EXPECT_GE(best.log_likelihood, before) << i;
      before = best.log_likelihood;
      kept = kept || best.origin == Origin::kept;
    }
    EXPECT_TRUE(kept);
  }
}

TEST(ParticleFilter, LocalOptimisationBeatsDiffusionAlone) {
  Scene scene;
  Pose start = both_arms_seen();
  start[Angle::l_shoulder_abduct] -= 12 * kDegree;
  start[Angle::r_elbow_flexion] += 12 * kDegree;
  const auto fit = [&](const std::string& heuristics, std::uint64_t seed) {
    RunningFilter filter = make_filter(scene, thesis(heuristics, 400), seed);
    filter.start(start);
    filter.step(input(scene, 0.0));
    double best = 1.0;
    for (const Particle& p : filter.particles()) {
      best = std::min(best, p.score.region());
    }
    return best;
  };
  double with = 0.0;
  double without = 0.0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    with += fit("lo", seed) / 6.0;
    without += fit("", seed) / 6.0;
  }
  EXPECT_LT(with, 0.6 * without);
}

TEST(ParticleFilter, LocalOptimisationEndsWithTheContours) {
  Scene scene;
  Pose start = both_arms_seen();
  start[Angle::l_shoulder_abduct] -= 12 * kDegree;
  const auto contour = [&](double region_share) {
    scene.search.region_share = region_share;
    double sum = 0.0;
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
      RunningFilter filter = make_filter(scene, thesis("lo", 400), seed);
      filter.start(start);
      filter.step(input(scene, 0.0));
      const auto& all = filter.particles();
      EXPECT_EQ(all.size(), 400U);
      sum += std::min_element(all.begin(), all.end(), [](const Particle& a, const Particle& b) {
               return a.score.contour() < b.score.contour();
             })->score.contour();
    }
    return sum / 6.0;
  };
  EXPECT_LT(contour(0.6), contour(1.0));
}

TEST(ParticleFilter, FlippingFindsTheArmThatTheImageShows) {
  Scene scene;
  for (const ArmAngles& arm : {ArmAngles{-60 * kDegree, 10 * kDegree, 40 * kDegree, -40 * kDegree},
                               ArmAngles{-40 * kDegree, 10 * kDegree, 40 * kDegree, -70 * kDegree},
                               ArmAngles{20 * kDegree, 10 * kDegree, 40 * kDegree, -100 * kDegree}}) {
    Pose truth = both_arms_seen();
    set_arm_angles(truth, Side::left, arm);
    scene.show(truth);
    const std::vector<Pose> flips = arm_flips(scene.model.body, truth, Side::left, scene.limits);
    ASSERT_FALSE(flips.empty());
    Pose start = flips.back();
    start[Angle::l_elbow_flexion] -= 4 * kDegree;  // otherwise the truth would be among its flips
    start[Angle::l_shoulder_flexion] += 3 * kDegree;
    ASSERT_GT(left_wrist_error(scene, start, truth), 0.2);
    const auto after_twelve = [&](const std::string& heuristics) {
      RunningFilter filter = make_filter(scene, thesis(heuristics, 150));
      filter.start(start);
      for (int i = 0; i < 11; ++i) {
        filter.step(input(scene, 0.0));
      }
      return left_wrist_error(scene, filter.step(input(scene, 0.0)).pose, truth);
    };
    EXPECT_LT(after_twelve("wd,kf"), 0.05);
    EXPECT_GT(after_twelve("wd"), 0.2) << "it finds the way alone, so flipping is not needed";
  }
}

// The image says a little more for one hypothesis in each frame, less than the jump to it from the other
// costs.
TEST(ParticleFilter, AHypothesisThatAlwaysFitsBetterWins) {
  Scene scene;
  Pose wrong = both_arms_seen();
  wrong[Angle::l_elbow_flexion] -= 60 * kDegree;
  FilterConfig config;
  config.heuristics = "modes,wd";
  config.diffusion = 0.001;
  config.natural = 0.0;
  config.temporal = 8.0;  // the jump costs about 2 nats
  scene.config.trust = 1.0;
  const auto likelihood = [&](const Pose& pose) {
    Score score;
    scene.evaluators.evaluate(scene.frame, scene.model, {&pose, 1}, {&score, 1});
    return log_likelihood(scene.context(), pose, score, 0);
  };
  scene.config.temporal = scene.config.natural = 0.0;
  constexpr double kEvidence = 0.6;  // nats a frame
  config.trust = kEvidence / (likelihood(both_arms_seen()) - likelihood(wrong));
  ASSERT_GT(config.trust, 0.0);
  RunningFilter filter = make_filter(scene, config);
  filter.start(wrong);
  filter.state.particles.front().weight = 0.9;
  Particle other = filter.state.particles.front();
  other.pose = other.before = both_arms_seen();
  other.weight = 0.1;
  filter.state.particles.push_back(other);
  for (int i = 0; i < 20; ++i) {
    filter.step(input(scene, 0.5));
  }
  EXPECT_LT(left_wrist_error(scene, filter.state.estimate, both_arms_seen()), 0.02);
}

TEST(ParticleFilter, EachParticleKnowsThePoseOfItsParent) {
  Scene scene;
  RunningFilter filter = started(scene, thesis("wd", 20));
  filter.step(input(scene, 0.0));
  const std::vector<Particle> parents = filter.particles();
  filter.step(input(scene, 0.0));
  for (const Particle& particle : filter.particles()) {
    EXPECT_EQ(particle.before.vector(), parents.at(static_cast<std::size_t>(particle.parent)).pose.vector());
  }
}

TEST(ParticleFilter, WithoutAPersonTheNumbersStayFinite) {
  Scene scene;
  Pose away = both_arms_seen();
  away.root.x() = 50.0;
  const PreparedFrame nobody = frame_of_model(scene.model, away, scene.camera);
  FilterConfig ours;
  ours.particles = 100;
  for (const FilterConfig& config : {thesis("", 100), thesis("wd,hpm,ee,lo,kf", 100), ours}) {
    RunningFilter filter = started(scene, config);
    for (int i = 0; i < 4; ++i) {
      const FilterResult found =
          filter.step({.frame = i == 3 ? scene.frame : nobody, .model = scene.model, .velocity = 0.5});
      EXPECT_TRUE(found.pose.vector().allFinite());
      EXPECT_TRUE(std::isfinite(found.score.region()) && std::isfinite(found.score.contour()));
      EXPECT_TRUE(found.effective_particles >= 1.0 - 1e-9);
      for (const Particle& p : filter.particles()) {
        ASSERT_TRUE(p.pose.vector().allFinite());
        ASSERT_TRUE(std::isfinite(p.weight) && std::isfinite(p.log_likelihood));
      }
    }
  }
}

TEST(ParticleFilter, OneParticleIsEnoughToGoOn) {
  Scene scene;
  for (const bool ours : {false, true}) {
    for (const std::string list : {"", "wd", "wd,hpm,ee,lo,kf", "modes,wd,lo,turn,kf"}) {
      FilterConfig config = thesis(list, 1);
      config.blocks = ours;
      RunningFilter filter = started(scene, config);
      for (int i = 0; i < 3; ++i) {
        const FilterResult found = filter.step(input(scene, 0.0));
        EXPECT_TRUE(found.pose.vector().allFinite()) << list;
        EXPECT_GE(filter.particles().size(), 1U) << list;
        EXPECT_GE(found.evaluations, 1) << list;
      }
    }
  }
}

TEST(ParticleFilter, StartsStopsAndStartsAgain) {
  Scene scene;
  RunningFilter filter = make_filter(scene, thesis("", 20));
  EXPECT_FALSE(filter.state.started());
  EXPECT_THROW(filter.step(input(scene, 0.0)), Error);
  Pose outside = both_arms_seen();
  outside[Angle::l_elbow_flexion] = -4.0;
  filter.start(outside);
  ASSERT_TRUE(filter.state.started());
  ASSERT_EQ(filter.particles().size(), 1U);
  EXPECT_TRUE(scene.limits.contains(filter.particles()[0].pose));
  filter.step(input(scene, 0.0));
  EXPECT_EQ(filter.particles().size(), 20U);
  filter.state.particles.clear();
  EXPECT_FALSE(filter.state.started());
  EXPECT_THROW(filter.step(input(scene, 0.0)), Error);
}

TEST(ParticleFilter, RefusesSettingsThatCannotBe) {
  Scene scene;
  EXPECT_THROW(make_filter(scene, thesis("", 0)), Error);
  EXPECT_THROW(make_filter(scene, thesis("none", 10)), Error);
  FilterConfig config;
  config.model = "/nowhere/numbers.json";
  EXPECT_THROW(make_filter(scene, config), Error);
}

TEST(ParticleFilter, WithoutMotionThePartitionLetsNothingMove) {
  Scene scene;
  RunningFilter filter = started(scene, thesis("hpm", 30));
  EXPECT_EQ(filter.step(input(scene, 0.0)).moving, all_parts()) << "there is no frame before";
  const Pose before = best_of(filter).pose;
  const FilterResult found = filter.step(input(scene, 0.0));
  EXPECT_LT((scene.joints(found.pose)[Joint::neck] - scene.joints(before)[Joint::neck]).norm(), 0.05);
}

}  // namespace
}  // namespace telemime
