// SPDX-License-Identifier: Apache-2.0
#include "telemime/search/objective.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <span>

#include "telemime/body/arm_ik.h"
#include "telemime/body/rotations.h"

namespace telemime {
namespace {

// Notes what it is asked to count.
class Asked final : public Backend {
 public:
  std::string_view name() const override { return "asked"; }
  void count(const PreparedFrame&, const Model&, std::span<const Pose>, std::span<const Kinematics>,
             Reduction terms, std::span<Reductions>) override {
    last = terms;
  }
  Reduction last = Reduction::none;
};

TEST(Objective, OnlyTrustedCuesAreCounted) {
  const Model model = make_model(Shape{});
  const JointLimits limits = anatomical_limits();
  CueValues regions{};
  regions[cue::kRegion] = 1.0;
  const auto counted = [&](bool has_colours) {
    PreparedFrame frame;
    frame.has_colours = has_colours;
    Asked backend;
    Objective objective(backend, frame, model, limits);
    objective(Pose{}, {.cues = regions});
    return backend.last;
  };
  EXPECT_EQ(counted(true), kCues[cue::kRegion].needs);
  EXPECT_EQ(counted(false), Reduction::none) << "without colours the regions say nothing";
}

TEST(PriorBetween, ATrunkThatTurnsThroughTheBackStaysThere) {
  const Body body = make_body(Shape{});
  Pose before;
  before[Angle::root_torsion] = 3.1;
  Pose after;
  after[Angle::root_torsion] = -3.1;
  for (const double share : {0.25, 0.5, 0.75}) {
    const Pose between = prior_between(body, before, after, share, 0.0).predicted->pose;
    const double turn = 3.1 + share * (2.0 * std::numbers::pi - 6.2);
    EXPECT_NEAR(wrap_angle(between[Angle::root_torsion] - turn), 0.0, 1e-12) << share;
    EXPECT_LE(std::abs(between[Angle::root_torsion]), std::numbers::pi);
  }
}

TEST(Objective, ATrunkThatTurnsThroughTheBackHasHardlyChanged) {
  const Model model = make_model(Shape{});
  const JointLimits limits = anatomical_limits();
  Asked backend;
  const PreparedFrame frame;
  Pose predicted;
  predicted[Angle::root_torsion] = 3.13;
  Objective objective(backend, frame, model, limits, prior_at(model.body, predicted));
  const auto cost = [&](double torsion) {
    Pose pose = predicted;
    pose[Angle::root_torsion] = torsion;
    return objective(pose, {.trunk = 1.0});
  };
  EXPECT_LT(cost(-3.13), cost(3.0));
}

TEST(PredictPose, AnArmThatWasFoundElsewhereStays) {
  const JointLimits limits = anatomical_limits();
  Pose before;
  set_arm_angles(before, Side::left, {-0.3, 0.2, 0.8, -1.0});
  set_arm_angles(before, Side::right, {-0.3, -0.2, -0.8, -1.0});
  Pose now = before;
  now[Angle::l_elbow_flexion] -= 0.4;
  now[Angle::r_shoulder_flexion] -= 1.4;  // as a mirror image in depth
  const Pose predicted = predict_pose(now, before, 0.5, 1.0, limits);
  EXPECT_NEAR(predicted[Angle::l_elbow_flexion], now[Angle::l_elbow_flexion] - 0.2, 1e-12);
  EXPECT_EQ(predicted[Angle::r_shoulder_flexion], now[Angle::r_shoulder_flexion]);
  // In twice the time the same change is a motion.
  const Pose slower = predict_pose(now, before, 0.25, 2.0, limits);
  EXPECT_NEAR(slower[Angle::r_shoulder_flexion], now[Angle::r_shoulder_flexion] - 0.35, 1e-12);
}

TEST(ShareOfMotion, FollowsTheTimeBetweenFrames) {
  EXPECT_DOUBLE_EQ(share_of_motion(0.5, 1.0, 1.0), 0.5);
  EXPECT_DOUBLE_EQ(share_of_motion(0.5, 1.0, 2.0), 0.25);
  EXPECT_DOUBLE_EQ(share_of_motion(0.5, 1.5, 1.0), 0.75);
  EXPECT_DOUBLE_EQ(share_of_motion(0.5, 8.0, 0.2), 1.0) << "frames in pairs: the last motion is noise";
}

}  // namespace
}  // namespace telemime
