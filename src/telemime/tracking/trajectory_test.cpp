// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracking/trajectory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "telemime/body/testing_poses.h"
#include "telemime/core/errors.h"
#include "telemime/likelihood/all.h"
#include "telemime/tracking/testing_scene.h"

namespace telemime {
namespace {

using testing_poses::farthest_joint;
using testing_scene::both_arms_seen;
using testing_scene::kDegree;
using testing_scene::Scene;

Pose raised(double degrees) {
  Pose pose = both_arms_seen();
  pose[Angle::l_shoulder_abduct] += degrees * kDegree;
  return pose;
}

TrajectoryContext context_of(Scene& scene, const TrajectoryConfig& config) {
  return {scene.model, scene.limits, scene.search, config, scene.evaluators};
}

TrajectoryFrame frame_with(const Scene& scene, const Pose& truth, std::vector<Pose> candidates) {
  return {frame_of_model(scene.model, truth, scene.camera), 0.0, std::move(candidates), 1};
}

double cost_of(const Body& body, const std::vector<std::vector<ScoredPose>>& frames,
               const std::vector<std::size_t>& way, std::span<const double> motion) {
  double sum = 0.0;
  for (std::size_t t = 0; t < frames.size(); ++t) {
    const ScoredPose& here = frames[t][way[t]];
    sum += here.cost;
    if (t > 0) {
      sum += motion[t] *
             distance_from_predicted(forward_kinematics(body, here.pose),
                                     forward_kinematics(body, frames[t - 1][way[t - 1]].pose).joints);
    }
  }
  return sum;
}

TEST(CheapestWay, IsTheBestOfAllWays) {
  const Body body = make_body(Shape{});
  Random random(5);
  for (int repeat = 0; repeat < 20; ++repeat) {
    std::vector<std::vector<ScoredPose>> frames(5);
    for (auto& frame : frames) {
      for (int i = 0; i < 3; ++i) {
        frame.push_back({raised(random.uniform(-40.0, 40.0)), random.uniform()});
      }
    }
    std::vector<double> motion;
    for (std::size_t t = 0; t < frames.size(); ++t) {
      motion.push_back(random.uniform(0.1, 3.0));
    }
    double least = std::numeric_limits<double>::infinity();
    std::vector<std::size_t> way(frames.size());
    const std::function<void(std::size_t)> each = [&](std::size_t t) {
      if (t == frames.size()) {
        least = std::min(least, cost_of(body, frames, way, motion));
        return;
      }
      for (way[t] = 0; way[t] < 3; ++way[t]) {
        each(t + 1);
      }
    };
    each(0);
    EXPECT_NEAR(cost_of(body, frames, cheapest_path(body, frames, motion, nullptr), motion), least, 1e-9);
  }
}

TEST(CheapestWay, WithoutACostOfMotionEachFrameIsOnItsOwn) {
  const Body body = make_body(Shape{});
  const std::vector<std::vector<ScoredPose>> frames = {{{raised(0), 0.3}, {raised(30), 0.2}},
                                                       {{raised(0), 0.1}, {raised(30), 0.2}}};
  EXPECT_EQ(cheapest_path(body, frames, std::array{0.0, 0.0}, nullptr), (std::vector<std::size_t>{1, 0}));
}

TEST(CheapestWay, GoesOnFromThePoseBefore) {
  const Body body = make_body(Shape{});
  const std::vector<std::vector<ScoredPose>> frames = {{{raised(0), 0.1}, {raised(60), 0.11}}};
  const Pose before = raised(60);
  EXPECT_EQ(cheapest_path(body, frames, std::array{0.1}, nullptr).front(), 0U);
  EXPECT_EQ(cheapest_path(body, frames, std::array{0.1}, &before).front(), 1U);
}

TEST(BestTrajectory, FramesFarApartMayDifferMore) {
  // The image shows the raised arm; staying where it was costs less, unless there was time to move.
  Scene scene;
  std::vector<TrajectoryFrame> frames = {frame_with(scene, raised(0), {raised(0)}),
                                         frame_with(scene, raised(60), {raised(0), raised(60)})};
  TrajectoryConfig config;
  config.sweeps = 0;
  const auto distance_at_end = [&](double step) {
    frames[1].time_step = step;
    Random random(1);
    const Pose end = best_trajectory(context_of(scene, config), frames, nullptr, random)[1];
    return farthest_joint(scene.joints(end), scene.joints(raised(60)));
  };
  config.motion = 1.0;
  EXPECT_GT(distance_at_end(1.0), 0.2);
  EXPECT_LT(distance_at_end(8.0), 0.1);
}

TEST(BestTrajectory, ATrunkMayLeaveTheLineWhereThereIsTime) {
  Scene scene;
  scene.search.region.trunk = scene.search.edge.trunk = 0.2;
  Pose aside = raised(0);
  aside.root.x() += 0.1;
  std::vector<TrajectoryFrame> frames = {frame_with(scene, raised(0), {raised(0)}),
                                         frame_with(scene, aside, {aside}),
                                         frame_with(scene, raised(0), {raised(0)})};
  const auto pulled = [&](double step) {
    for (TrajectoryFrame& frame : frames) {
      frame.time_step = step;
    }
    Random random(1);
    return std::abs(best_trajectory(context_of(scene, {}), frames, nullptr, random)[1].root.x() -
                    aside.root.x());
  };
  EXPECT_GT(pulled(1.0), 2.0 * pulled(8.0));
}

TEST(CheapestWay, OfNoFramesIsEmpty) {
  EXPECT_TRUE(cheapest_path(make_body(Shape{}), {}, {}, nullptr).empty());
}

TEST(Combine, OrdersByCostAndKeepsNoMoreThanAsked) {
  Scene scene;
  TrajectoryConfig config;
  config.kept = 7;
  const TrajectoryFrame frame = frame_with(scene, raised(0), {raised(20), raised(-20)});
  const auto scalar = make_backend("scalar");
  const auto poses = combine(context_of(scene, config), frame, *scalar);
  ASSERT_EQ(poses.size(), 7U);
  EXPECT_TRUE(std::is_sorted(poses.begin(), poses.end(),
                             [](const ScoredPose& a, const ScoredPose& b) { return a.cost < b.cost; }));
}

TEST(Combine, NoPoseComesTwice) {
  Scene scene;
  const TrajectoryConfig config;
  const TrajectoryFrame frame =
      frame_with(scene, raised(0), {raised(20), raised(20), raised(-20), raised(20)});
  const auto scalar = make_backend("scalar");
  const auto poses = combine(context_of(scene, config), frame, *scalar);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_NE(poses[i].pose.vector(), poses[j].pose.vector()) << i << " and " << j;
    }
  }
}

TEST(Combine, TakesEachArmFromWhereItIsRight) {
  Scene scene;
  const Pose truth = both_arms_seen();
  Pose left_right = truth;  // only the left arm is correct
  left_right[Angle::r_shoulder_abduct] -= 40 * kDegree;
  Pose right_right = truth;
  right_right[Angle::l_shoulder_abduct] += 40 * kDegree;
  const TrajectoryFrame frame = frame_with(scene, truth, {left_right, right_right});
  const TrajectoryConfig config;
  const auto scalar = make_backend("scalar");
  const auto poses = combine(context_of(scene, config), frame, *scalar);
  double nearest = 1.0;
  for (const ScoredPose& p : poses) {
    nearest = std::min(nearest, farthest_joint(scene.joints(p.pose), scene.joints(truth)));
  }
  EXPECT_LT(nearest, 0.01);
}

TEST(Combine, OneCandidateIsEnough) {
  Scene scene;
  const TrajectoryConfig config;
  const TrajectoryFrame frame = frame_with(scene, raised(0), {raised(0)});
  const auto scalar = make_backend("scalar");
  EXPECT_FALSE(combine(context_of(scene, config), frame, *scalar).empty());
}

// Frames in which the left arm rises; in one of them the filter lost it.
std::vector<TrajectoryFrame> with_one_lost(Scene& scene, std::size_t wrong) {
  std::vector<TrajectoryFrame> frames;
  for (std::size_t t = 0; t < 7; ++t) {
    const Pose truth = raised(2.0 * static_cast<double>(t));
    Pose seen = truth;
    if (t == wrong) {
      seen[Angle::l_shoulder_flexion] -= 50 * kDegree;
    }
    frames.push_back(frame_with(scene, truth, {seen, truth}));
  }
  return frames;
}

TEST(BestTrajectory, MendsAFrameBetweenFramesThatAreRight) {
  Scene scene;
  const auto frames = with_one_lost(scene, 3);
  TrajectoryConfig config;
  Random random(1);
  const auto poses = best_trajectory(context_of(scene, config), frames, nullptr, random);
  ASSERT_EQ(poses.size(), frames.size());
  const double was = farthest_joint(scene.joints(frames[3].candidates.front()), scene.joints(raised(6)));
  const double now = farthest_joint(scene.joints(poses[3]), scene.joints(raised(6)));
  EXPECT_GT(was, 0.1);
  EXPECT_LT(now, 0.05);
}

TEST(BestTrajectory, SamePosesForAnyNumberOfThreads) {
  Scene scene;
  const auto frames = with_one_lost(scene, 2);
  TrajectoryConfig config;
  config.evaluations = 200;
  Random first(1);
  const auto one = best_trajectory(context_of(scene, config), frames, nullptr, first);
  Evaluators two("scalar", 2);
  const TrajectoryContext context{.model = scene.model,
                                  .limits = scene.limits,
                                  .search = scene.search,
                                  .config = config,
                                  .evaluators = two};
  Random second(1);
  const auto many = best_trajectory(context, frames, nullptr, second);
  for (std::size_t t = 0; t < one.size(); ++t) {
    EXPECT_EQ(one[t].vector(), many[t].vector()) << t;
  }
}

TEST(BestTrajectory, NoFramesGiveNoPoses) {
  Scene scene;
  const TrajectoryConfig config;
  Random random(1);
  EXPECT_TRUE(best_trajectory(context_of(scene, config), {}, nullptr, random).empty());
}

TEST(TrajectoryConfig, RefusesWhatIsOutOfRange) {
  EXPECT_NO_THROW(check_settings(TrajectoryConfig{}));
  const auto refused = [](const std::function<void(TrajectoryConfig&)>& change) {
    TrajectoryConfig config;
    change(config);
    EXPECT_THROW(check_settings(config), Error);
  };
  refused([](auto& c) { c.stretch = 0; });
  refused([](auto& c) { c.overlap = -1; });
  refused([](auto& c) { c.arms = 0; });
  refused([](auto& c) { c.kept = 0; });
  refused([](auto& c) { c.motion = -0.1; });
  refused([](auto& c) { c.between = -0.1; });
  refused([](auto& c) { c.sweeps = -1; });
  refused([](auto& c) { c.evaluations = 0; });
}

}  // namespace
}  // namespace telemime
