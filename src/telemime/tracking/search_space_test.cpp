// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracking/search_space.h"

#include <gtest/gtest.h>

#include "telemime/body/rotations.h"
#include "telemime/body/testing_poses.h"
#include "telemime/tracking/testing_scene.h"

namespace telemime {
namespace {

using testing_poses::bent_pose;
using testing_poses::farthest_joint;
using testing_scene::both_arms_seen;
using testing_scene::kDegree;
using testing_scene::Scene;

constexpr double kTenthOfMillimetre = 1e-4;

PartSet only(Part part) {
  return PartSet().set(static_cast<std::size_t>(part));
}

TEST(SearchSpace, StartDecodesToThePose) {
  Scene scene;
  const FilterContext context = scene.context();
  Random random(1);
  for (int i = 0; i < 200; ++i) {
    const Pose pose = bent_pose(scene.limits, random);
    const SearchSpace angles = search_space(context, pose, all_parts(), false);
    ASSERT_EQ(angles.block.start.size(), static_cast<Eigen::Index>(kPoseSize));
    ASSERT_LT((angles.block.decode(angles.block.start).vector() - pose.vector()).norm(), 1e-9);
    ASSERT_LT((angles.within_reach(angles.block.start)->vector() - pose.vector()).norm(), 1e-9);
    const SearchSpace wrists = search_space(context, pose, all_parts(), true);
    const JointPositions own = scene.joints(pose);
    ASSERT_LT(farthest_joint(scene.joints(wrists.block.decode(wrists.block.start)), own), kTenthOfMillimetre)
        << i;
    const auto reached = wrists.within_reach(wrists.block.start);
    ASSERT_TRUE(reached) << i;
    ASSERT_LT(farthest_joint(scene.joints(*reached), own), kTenthOfMillimetre) << i;
  }
}

TEST(SearchSpace, AnArmComesBackFromItsWristAndSwivel) {
  const Body body = make_body(testing_poses::other_shape());
  const JointLimits limits = anatomical_limits();
  Random random(2);
  for (int i = 0; i < 1000; ++i) {
    const Pose pose = bent_pose(limits, random);
    const JointPositions own = forward_kinematics(body, pose).joints;
    for (const Side side : testing_poses::kSides) {
      const auto angles = solve_arm(body, pose, side, arm_target(body, pose, side), limits);
      ASSERT_TRUE(angles) << i;
      Pose again = pose;
      set_arm_angles(again, side, *angles);
      ASSERT_LT(farthest_joint(forward_kinematics(body, again).joints, own), kTenthOfMillimetre) << i;
    }
  }
}

TEST(SearchSpace, PartsThatDoNotMoveStay) {
  Scene scene;
  const FilterContext context = scene.context();
  const Pose pose = both_arms_seen();
  Random random(3);
  for (unsigned set = 0; set < 16; ++set) {
    const PartSet parts(set);
    for (const bool end_effector : {false, true}) {
      const SearchSpace space = search_space(context, pose, parts, end_effector);
      PoseVector moved = PoseVector::Zero();
      for (int i = 0; i < 20; ++i) {
        moved += (diffused(context, space, random).vector() - pose.vector()).cwiseAbs();
      }
      for (std::size_t k = 0; k < kPoseSize; ++k) {
        const double way = moved[static_cast<Eigen::Index>(k)];
        EXPECT_EQ(way > 0.0, has(parts, part_of_number(k))) << "number " << k << " of " << parts;
      }
    }
  }
}

TEST(SearchSpace, StepsAreScaledStandardDeviations) {
  Scene scene;
  scene.config.diffusion = 0.5;
  const Pose pose = both_arms_seen();
  const SearchSpace angles = search_space(scene.context(), pose, all_parts(), false);
  EXPECT_TRUE(angles.block.steps.isApprox(0.5 * scene.numbers.change));
  const SearchSpace wrist = search_space(scene.context(), pose, only(Part::right_arm), true);
  const double z = scene.joints(pose)[Joint::r_wrist].z();
  ASSERT_EQ(wrist.block.steps.size(), 7);
  EXPECT_NEAR(wrist.block.steps[0] * z, 0.5 * scene.numbers.wrist_across, 1e-9);
  EXPECT_NEAR(wrist.block.steps[1] * z, 0.5 * scene.numbers.wrist_across, 1e-9);
  EXPECT_NEAR(wrist.block.steps[2], 0.5 * scene.numbers.wrist_along, 1e-9);
  EXPECT_NEAR(wrist.block.steps[3], 0.5 * scene.numbers.swivel, 1e-9);
}

TEST(Diffused, StaysInsideTheLimits) {
  Scene scene;
  scene.config.diffusion = 4.0;
  const FilterContext context = scene.context();
  Random random(4);
  for (int i = 0; i < 60; ++i) {
    Pose pose = bent_pose(scene.limits, random);
    if (i % 3 == 0) {  // in a corner of the limits
      for (std::size_t a = 0; a < kAngleCount; ++a) {
        pose.angles[a] = random.uniform() < 0.5 ? scene.limits.min[a] : scene.limits.max[a];
      }
    }
    for (const bool end_effector : {false, true}) {
      const SearchSpace space = search_space(context, pose, all_parts(), end_effector);
      for (int k = 0; k < 20; ++k) {
        const Pose drawn = diffused(context, space, random);
        ASSERT_TRUE(drawn.vector().allFinite());
        ASSERT_TRUE(scene.limits.contains(drawn)) << i << " " << end_effector;
        ASSERT_GT(drawn.root.z(), 0.0);
      }
    }
  }
}

TEST(Diffused, AtALimitDoesNotPileUpThere) {
  Scene scene;
  const FilterContext context = scene.context();
  Pose pose = both_arms_seen();
  const auto elbow = static_cast<std::size_t>(Angle::l_elbow_flexion);
  pose.angles[elbow] = scene.limits.max[elbow];
  const SearchSpace space = search_space(context, pose, only(Part::left_arm), false);
  Random random(5);
  int there = 0;
  for (int i = 0; i < 1000; ++i) {
    there += diffused(context, space, random).angles[elbow] == scene.limits.max[elbow];
  }
  EXPECT_LT(there, 20) << "drawn again, not cut off";
}

TEST(Diffused, ReachesTheWholeSpreadInAngles) {
  Scene scene;
  scene.config.diffusion = 0.2;
  const FilterContext context = scene.context();
  const Pose pose = scene.limits.clamp(both_arms_seen());
  const SearchSpace space = search_space(context, pose, all_parts(), false);
  Random random(6);
  std::vector<std::vector<double>> numbers(kPoseSize);
  for (int i = 0; i < 2000; ++i) {
    const PoseVector drawn = diffused(context, space, random).vector();
    for (std::size_t k = 0; k < kPoseSize; ++k) {
      numbers[k].push_back(drawn[static_cast<Eigen::Index>(k)]);
    }
  }
  for (std::size_t k = 0; k < kPoseSize; ++k) {
    const double asked = 0.2 * scene.numbers.change[static_cast<Eigen::Index>(k)];
    EXPECT_NEAR(testing_scene::deviation_of(numbers[k]), asked, 0.08 * asked) << k;
    EXPECT_NEAR(testing_scene::mean_of(numbers[k]), pose.vector()[static_cast<Eigen::Index>(k)], 0.12 * asked)
        << k;
  }
}

TEST(WithinReach, AWristOutOfReachIsNoPose) {
  Scene scene;
  const Pose pose = both_arms_seen();
  const double reach = scene.model.body.upper_arm_length[0] + scene.model.body.forearm_length[0];
  for (const auto& [part, joint] :
       {std::pair{Part::left_arm, Joint::l_wrist}, std::pair{Part::right_arm, Joint::r_wrist}}) {
    const SearchSpace space = search_space(scene.context(), pose, only(part), true);
    for (const double away : {-1.0, 1.0}) {
      Eigen::VectorXd x = space.block.start;
      x[2] += away * 2.0 * reach;
      EXPECT_FALSE(space.within_reach(x));
      EXPECT_TRUE(space.block.decode(x).vector().allFinite()) << "as near as it comes";
    }
    Eigen::VectorXd x = space.block.start;
    x[0] += 0.01;
    x[2] -= 0.02;
    const auto near = space.within_reach(x);
    ASSERT_TRUE(near);
    const Eigen::Vector3d asked(x[0] * x[2], x[1] * x[2], x[2]);
    EXPECT_LT((scene.joints(*near)[joint] - asked).norm(), kTenthOfMillimetre);
  }
}

TEST(Diffused, WristsSpreadAcrossAndAlongTheRay) {
  constexpr int kDraws = 4000;
  Scene scene;
  scene.config.diffusion = 0.15;  // so that hardly any draw is out of reach or outside the limits
  const FilterContext context = scene.context();
  const Pose pose = both_arms_seen();
  for (const auto& [side, part] :
       {std::pair{Side::left, Part::left_arm}, std::pair{Side::right, Part::right_arm}}) {
    const SearchSpace space = search_space(context, pose, only(part), true);
    const ArmTarget start = arm_target(scene.model.body, pose, side);
    Random random(7);
    std::array<std::vector<double>, 4> seen;  // m right, m down, m away, rad
    for (int i = 0; i < kDraws; ++i) {
      const ArmTarget drawn = arm_target(scene.model.body, diffused(context, space, random), side);
      seen[0].push_back(start.wrist.z() * drawn.wrist.x() / drawn.wrist.z());
      seen[1].push_back(start.wrist.z() * drawn.wrist.y() / drawn.wrist.z());
      seen[2].push_back(drawn.wrist.z());
      seen[3].push_back(wrap_angle(drawn.swivel - start.swivel));
    }
    const std::array<double, 4> asked = {scene.numbers.wrist_across, scene.numbers.wrist_across,
                                         scene.numbers.wrist_along, scene.numbers.swivel};
    const std::array<double, 4> middle = {start.wrist.x(), start.wrist.y(), start.wrist.z(), 0.0};
    // The standard error of a deviation of so many draws is 1.1 %, of the mean 1.6 % of it.
    for (std::size_t k = 0; k < 4; ++k) {
      const double deviation = 0.15 * asked[k];
      EXPECT_NEAR(testing_scene::deviation_of(seen[k]), deviation, 0.05 * deviation) << k;
      EXPECT_NEAR(testing_scene::mean_of(seen[k]), middle[k], 0.07 * deviation) << k;
      for (std::size_t l = 0; l < k; ++l) {
        EXPECT_NEAR(testing_scene::covariance_of(seen[k], seen[l]) / (deviation * 0.15 * asked[l]), 0.0, 0.07)
            << "depth, place in the image and swivel are drawn apart";
      }
    }
  }
}

}  // namespace
}  // namespace telemime
