// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracking/heuristics/arm_exchange.h"

#include <gtest/gtest.h>

#include "telemime/body/testing_poses.h"
#include "telemime/search/arm_exchange.h"
#include "telemime/tracking/testing_scene.h"

namespace telemime {
namespace {

using testing_scene::both_arms_seen;
using testing_scene::kDegree;
using testing_scene::Scene;

Pose bent(Angle elbow, double degrees) {
  Pose pose = both_arms_seen();
  pose[elbow] -= degrees * kDegree;
  return pose;
}

Generation with(const std::vector<std::pair<Pose, double>>& poses) {
  Generation generation;
  for (const auto& [pose, log_likelihood] : poses) {
    Particle p;
    p.pose = pose;
    p.log_likelihood = log_likelihood;
    p.parent = 7;
    p.measured = true;
    generation.particles.push_back(p);
  }
  return generation;
}

TEST(ArmExchange, JoinsTheBestArmsOfTwo) {
  Scene scene;
  scene.frame.landmarks.emplace();
  // The best has a bent left arm, the second a bent right arm: one with both is missing.
  const Pose left = bent(Angle::l_elbow_flexion, 40);
  const Pose right = bent(Angle::r_elbow_flexion, 40);
  Pose both = left;
  both[Angle::r_elbow_flexion] = right[Angle::r_elbow_flexion];
  Generation generation = with({{right, -2.0}, {left, -1.0}});
  exchange_best_arms(scene.context(), generation);
  ASSERT_EQ(generation.particles.size(), 5U) << "two arms a side, but for the pair that was there";
  double nearest = 1.0;
  for (std::size_t i = 2; i < generation.particles.size(); ++i) {
    const Particle& p = generation.particles[i];
    EXPECT_FALSE(p.measured);
    EXPECT_EQ(p.parent, 7);
    EXPECT_EQ(p.origin, Origin::exchanged);
    EXPECT_DOUBLE_EQ(p.prior, 1.0 / scene.config.particles);
    nearest = std::min(nearest, testing_poses::farthest_joint(scene.joints(p.pose), scene.joints(both)));
  }
  EXPECT_LT(nearest, 1e-3) << "m";
}

TEST(ArmExchange, NeedsLandmarksAndDifferentArms) {
  Scene scene;
  Generation alike = with({{both_arms_seen(), -1.0}, {bent(Angle::l_elbow_flexion, 1), -2.0}});
  Generation different = with({{both_arms_seen(), -1.0}, {bent(Angle::l_elbow_flexion, 40), -2.0}});
  exchange_best_arms(scene.context(), different);
  EXPECT_EQ(different.particles.size(), 2U) << "no landmarks";
  scene.frame.landmarks.emplace();
  exchange_best_arms(scene.context(), alike);
  EXPECT_EQ(alike.particles.size(), 2U) << "one arm a side";
  Generation none;
  exchange_best_arms(scene.context(), none);
  EXPECT_TRUE(none.particles.empty());
}

TEST(WithArmsOf, KeepsTheWristsOnATurnedTrunk) {
  const Scene scene;
  const Body& body = scene.model.body;
  Pose turned = both_arms_seen();
  turned[Angle::root_tilt] += 3 * kDegree;
  const Pose left = bent(Angle::l_elbow_flexion, 30);
  const Pose right = bent(Angle::r_elbow_flexion, 20);
  const JointPositions made = scene.joints(with_arms_of(body, turned, left, right, scene.limits));
  EXPECT_LT((made[Joint::l_wrist] - scene.joints(left)[Joint::l_wrist]).norm(), 0.01);
  EXPECT_LT((made[Joint::r_wrist] - scene.joints(right)[Joint::r_wrist]).norm(), 0.01);
  EXPECT_LT((made[Joint::neck] - scene.joints(turned)[Joint::neck]).norm(), 1e-12);
}

}  // namespace
}  // namespace telemime
