// SPDX-License-Identifier: Apache-2.0
#include "telemime/body/body.h"

#include <gtest/gtest.h>

#include <ostream>
#include <string>

#include "telemime/body/arm_parts.h"
#include "telemime/body/limits.h"
#include "telemime/body/rotations.h"
#include "telemime/body/testing_poses.h"

namespace telemime {
namespace {

using testing_poses::kDegree;
using testing_poses::random_pose;
using testing_poses::twin;

const Eigen::Vector3d kLeft(1, 0, 0);  // the person's own, in the body frame
const Eigen::Vector3d kUp(0, 1, 0);
const Eigen::Vector3d kForward(0, 0, 1);

// Unit vector from one joint to another in the body frame at rest.
Eigen::Vector3d direction(const Body& body, const Pose& pose, Joint from, Joint to) {
  const Kinematics k = forward_kinematics(body, pose);
  return camera_from_body_at_rest() * (k.joints[to] - k.joints[from]).normalized();
}

// Axis of a segment's frame (a unit vector of it) in the body frame at rest.
Eigen::Vector3d axis(const Body& body, const Pose& pose, Segment segment, const Eigen::Vector3d& unit) {
  return camera_from_body_at_rest() * forward_kinematics(body, pose)[segment].linear() * unit;
}

TEST(ArmParts, HaveTheNamesOfTheirSide) {
  const auto segment = [](Segment s) { return kSegmentNames[static_cast<std::size_t>(s)]; };
  const auto joint = [](Joint j) { return kJointNames[static_cast<std::size_t>(j)]; };
  const auto angle = [](Angle a) { return kAngleNames[static_cast<std::size_t>(a)]; };
  for (const Side side : testing_poses::kSides) {
    const ArmParts& arm = arm_parts(side);
    const std::string own = side == Side::left ? "l_" : "r_";
    EXPECT_EQ(segment(arm.upper_arm), own + "upper_arm");
    EXPECT_EQ(segment(arm.forearm), own + "forearm");
    EXPECT_EQ(segment(arm.hand), own + "hand");
    EXPECT_EQ(joint(arm.shoulder), own + "shoulder");
    EXPECT_EQ(joint(arm.elbow), own + "elbow");
    EXPECT_EQ(joint(arm.wrist), own + "wrist");
    EXPECT_EQ(joint(arm.knuckle), own + "hand");
    EXPECT_EQ(angle(arm.shoulder_flexion), own + "shoulder_flexion");
    EXPECT_EQ(angle(arm.shoulder_twisting), own + "shoulder_twisting");
    EXPECT_EQ(angle(arm.shoulder_abduct), own + "shoulder_abduct");
    EXPECT_EQ(angle(arm.elbow_flexion), own + "elbow_flexion");
    EXPECT_EQ(angle(arm.wrist_flexion), own + "wrist_flexion");
    EXPECT_EQ(angle(arm.wrist_twisting), own + "wrist_twisting");
    EXPECT_EQ(angle(arm.wrist_pivot), own + "wrist_pivot");
    EXPECT_EQ(arm.wrist_angles(), (std::array{arm.wrist_flexion, arm.wrist_pivot, arm.wrist_twisting}));
  }
}

TEST(Body, RestPoseIsUprightFacingTheCameraWithHangingArms) {
  const Body body = make_body(Shape{});
  Pose pose;
  pose.root = {0.1, 0.2, 1.5};
  const JointPositions j = forward_kinematics(body, pose).joints;
  EXPECT_EQ(j[Joint::root], pose.root);
  EXPECT_TRUE(direction(body, pose, Joint::root, Joint::neck).isApprox(kUp, 1e-12));
  EXPECT_TRUE(direction(body, pose, Joint::r_shoulder, Joint::l_shoulder).isApprox(kLeft, 1e-12));
  for (const Joint shoulder : {Joint::l_shoulder, Joint::r_shoulder}) {
    const auto s = static_cast<std::size_t>(shoulder);
    for (std::size_t next = s + 2; next <= s + 6; next += 2) {  // elbow, wrist, hand
      EXPECT_TRUE(direction(body, pose, shoulder, static_cast<Joint>(next)).isApprox(-kUp, 1e-12));
    }
  }
  // y of the image points down, the person's left is on the image's right, the face is toward the camera.
  EXPECT_LT(j[Joint::head_top].y(), j[Joint::neck].y());
  EXPECT_GT(j[Joint::l_shoulder].x(), j[Joint::r_shoulder].x());
  EXPECT_LT(j[Joint::head].z(), j[Joint::neck].z());
}

TEST(Body, DefaultBodyHasHumanLengths) {
  const Body body = make_body(Shape{});
  const JointPositions j = forward_kinematics(body, Pose{}).joints;
  EXPECT_NEAR((j[Joint::l_shoulder] - j[Joint::r_shoulder]).norm(), 0.36, 0.03);
  EXPECT_NEAR((j[Joint::l_elbow] - j[Joint::l_shoulder]).norm(), 0.27, 0.02);
  EXPECT_NEAR((j[Joint::l_wrist] - j[Joint::l_elbow]).norm(), 0.25, 0.02);
  EXPECT_NEAR((j[Joint::head_top] - j[Joint::neck]).norm(), 0.25, 0.03);
}

struct QuarterTurn {
  Angle angle;
  double degrees;
  Joint from, to;
  Eigen::Vector3d expected;  // body frame
  bool bent_elbows = false;  // forearms forward before the turn
};
void PrintTo(const QuarterTurn& turn, std::ostream* out) {
  *out << kAngleNames[static_cast<std::size_t>(turn.angle)] << " by " << turn.degrees;
}

class AngleSigns : public ::testing::TestWithParam<QuarterTurn> {};

// The table of pose.h, each angle alone, against directions found by hand.
TEST_P(AngleSigns, QuarterTurnPointsWhereTheTableSays) {
  const QuarterTurn& turn = GetParam();
  const Body body = make_body(Shape{});
  Pose pose;
  if (turn.bent_elbows) {
    pose[Angle::l_elbow_flexion] = pose[Angle::r_elbow_flexion] = -90 * kDegree;
  }
  pose[turn.angle] = turn.degrees * kDegree;
  EXPECT_LT((direction(body, pose, turn.from, turn.to) - turn.expected).norm(), 1e-12);
}

INSTANTIATE_TEST_SUITE_P(
    Trunk, AngleSigns,
    ::testing::Values(QuarterTurn{Angle::root_torsion, 90, Joint::r_shoulder, Joint::l_shoulder, -kForward},
                      QuarterTurn{Angle::root_roll, 90, Joint::root, Joint::neck, -kLeft},
                      QuarterTurn{Angle::root_tilt, 90, Joint::root, Joint::neck, kForward},
                      QuarterTurn{Angle::neck_roll, 90, Joint::head, Joint::head_top, -kLeft},
                      QuarterTurn{Angle::neck_tilt, 90, Joint::head, Joint::head_top, kForward}));

INSTANTIATE_TEST_SUITE_P(
    Shoulders, AngleSigns,
    ::testing::Values(
        QuarterTurn{Angle::l_shoulder_flexion, -90, Joint::l_shoulder, Joint::l_wrist, kForward},
        QuarterTurn{Angle::r_shoulder_flexion, -90, Joint::r_shoulder, Joint::r_wrist, kForward},
        QuarterTurn{Angle::l_shoulder_abduct, 90, Joint::l_shoulder, Joint::l_wrist, kLeft},
        QuarterTurn{Angle::r_shoulder_abduct, -90, Joint::r_shoulder, Joint::r_wrist, -kLeft},
        QuarterTurn{Angle::l_shoulder_twisting, 90, Joint::l_elbow, Joint::l_wrist, kLeft, true},
        QuarterTurn{Angle::r_shoulder_twisting, 90, Joint::r_elbow, Joint::r_wrist, kLeft, true}));

INSTANTIATE_TEST_SUITE_P(
    ElbowsAndWrists, AngleSigns,
    ::testing::Values(QuarterTurn{Angle::l_elbow_flexion, -90, Joint::l_elbow, Joint::l_wrist, kForward},
                      QuarterTurn{Angle::r_elbow_flexion, -90, Joint::r_elbow, Joint::r_wrist, kForward},
                      QuarterTurn{Angle::l_wrist_pivot, 90, Joint::l_wrist, Joint::l_hand, -kForward},
                      QuarterTurn{Angle::r_wrist_pivot, 90, Joint::r_wrist, Joint::r_hand, -kForward},
                      QuarterTurn{Angle::l_wrist_flexion, 90, Joint::l_wrist, Joint::l_hand, kLeft},
                      QuarterTurn{Angle::r_wrist_flexion, 90, Joint::r_wrist, Joint::r_hand, kLeft}));

TEST(Body, TorsionsTurnTheFrontToThePersonsLeft) {
  const Body body = make_body(Shape{});
  const std::pair<Angle, Segment> turns[] = {{Angle::root_torsion, Segment::chest},
                                             {Angle::neck_torsion, Segment::head},
                                             {Angle::l_wrist_twisting, Segment::l_hand},
                                             {Angle::r_wrist_twisting, Segment::r_hand}};
  for (const auto& [angle, segment] : turns) {
    Pose pose;
    pose[angle] = 90 * kDegree;
    EXPECT_LT((axis(body, pose, segment, kForward) - kLeft).norm(), 1e-12)
        << kAngleNames[static_cast<std::size_t>(angle)];
  }
}

TEST(Body, RotationsComposeInTheDocumentedOrder) {
  const Body body = make_body(Shape{});
  Pose pose;  // Rz Rx Ry: lifted forward first, then abducted about the forward axis: still forward
  pose[Angle::l_shoulder_flexion] = -90 * kDegree;
  pose[Angle::l_shoulder_abduct] = 90 * kDegree;
  EXPECT_LT((direction(body, pose, Joint::l_shoulder, Joint::l_elbow) - kForward).norm(), 1e-12);

  Pose hand;  // Ry Rx Rz: bent to the left first, tipping about x does not move it, then turned backward
  hand[Angle::l_wrist_flexion] = 90 * kDegree;
  hand[Angle::l_wrist_pivot] = 90 * kDegree;
  hand[Angle::l_wrist_twisting] = 90 * kDegree;
  EXPECT_LT((direction(body, hand, Joint::l_wrist, Joint::l_hand) + kForward).norm(), 1e-12);

  Pose trunk;  // Rz Rx Ry: turned to the left first, leaning forward then, rolled to the right last
  trunk[Angle::root_torsion] = 90 * kDegree;
  trunk[Angle::root_tilt] = 90 * kDegree;
  trunk[Angle::root_roll] = 90 * kDegree;
  EXPECT_LT((axis(body, trunk, Segment::chest, kForward) - kUp).norm(), 1e-12);
  EXPECT_LT((axis(body, trunk, Segment::chest, kUp) - kForward).norm(), 1e-12);
}

TEST(Body, ShoulderRidesOnTheClavicle) {
  const Body body = make_body(Shape{});
  for (const Side side : testing_poses::kSides) {
    const Eigen::Vector3d hanging = shoulder_in_chest(body, side, -kUp);
    const Eigen::Vector3d raised = shoulder_in_chest(body, side, kUp);
    const Eigen::Vector3d stretched = shoulder_in_chest(body, side, kForward);
    EXPECT_NEAR(raised.y() - hanging.y(), body.clavicle_lift, 1e-12);
    EXPECT_NEAR(stretched.z() - hanging.z(), body.clavicle_reach, 1e-12);
    EXPECT_EQ(raised.x(), hanging.x());
  }
}

TEST(Body, BoneLengthsDoNotDependOnThePose) {
  const Body body = make_body(testing_poses::other_shape());
  const std::pair<Joint, Joint> bones[] = {
      {Joint::root, Joint::neck},          {Joint::neck, Joint::head},
      {Joint::head, Joint::head_top},      {Joint::l_shoulder, Joint::l_elbow},
      {Joint::r_shoulder, Joint::r_elbow}, {Joint::l_elbow, Joint::l_wrist},
      {Joint::r_elbow, Joint::r_wrist},    {Joint::l_wrist, Joint::l_hand},
      {Joint::r_wrist, Joint::r_hand}};
  const JointPositions rest = forward_kinematics(body, Pose{}).joints;
  Random random(1);
  for (int i = 0; i < 200; ++i) {
    const JointPositions j = forward_kinematics(body, random_pose(anatomical_limits(), random)).joints;
    for (const auto& [from, to] : bones) {
      ASSERT_NEAR((j[to] - j[from]).norm(), (rest[to] - rest[from]).norm(), 1e-12);
    }
  }
  EXPECT_NEAR((rest[Joint::l_elbow] - rest[Joint::l_shoulder]).norm(), body.upper_arm_length[0], 1e-12);
  EXPECT_NEAR((rest[Joint::r_hand] - rest[Joint::r_wrist]).norm(), body.hand_length[1], 1e-12);
}

TEST(Body, SegmentFramesAreRotationsAtTheirJoints) {
  const Body body = make_body(Shape{});
  const std::pair<Segment, Joint> origins[] = {{Segment::chest, Joint::root},
                                               {Segment::head, Joint::neck},
                                               {Segment::l_upper_arm, Joint::l_shoulder},
                                               {Segment::r_upper_arm, Joint::r_shoulder},
                                               {Segment::l_forearm, Joint::l_elbow},
                                               {Segment::r_forearm, Joint::r_elbow},
                                               {Segment::l_hand, Joint::l_wrist},
                                               {Segment::r_hand, Joint::r_wrist}};
  Random random(2);
  const Kinematics k = forward_kinematics(body, random_pose(anatomical_limits(), random));
  for (const auto& [segment, joint] : origins) {
    const Eigen::Matrix3d r = k[segment].linear();
    EXPECT_TRUE((r * r.transpose()).isIdentity(1e-12));
    EXPECT_NEAR(r.determinant(), 1.0, 1e-12);
    EXPECT_TRUE(k[segment].translation().isApprox(k.joints[joint], 1e-12));
  }
}

TEST(Body, MirroredPoseHasMirroredJoints) {
  const Body body = make_body(testing_poses::other_shape());
  Random random(3);
  for (int i = 0; i < 200; ++i) {
    const Pose pose = random_pose(anatomical_limits(), random);
    const JointPositions here = forward_kinematics(body, pose).joints;
    const JointPositions there = forward_kinematics(body, mirrored(pose)).joints;
    for (std::size_t j = 0; j < kJointCount; ++j) {
      const Eigen::Vector3d expected = here.at[j].cwiseProduct(Eigen::Vector3d(-1, 1, 1));
      ASSERT_LT((there[twin(static_cast<Joint>(j))] - expected).norm(), 1e-12) << kJointNames[j];
    }
  }
}

TEST(Body, ScalesActOnTheirOwnSegment) {
  const Body average = make_body(Shape{});
  Shape shape;
  shape[Segment::l_forearm].length = 1.2;
  shape[Segment::chest].width = 1.1;
  const Body body = make_body(shape);
  EXPECT_NEAR(body.forearm_length[0], 1.2 * average.forearm_length[0], 1e-12);
  EXPECT_EQ(body.forearm_length[1], average.forearm_length[1]);
  EXPECT_EQ(body.upper_arm_length, average.upper_arm_length);
  EXPECT_NEAR(body.shoulder_from_neck[0].x(), 1.1 * average.shoulder_from_neck[0].x(), 1e-12);
  Shape tall;
  tall.stature = 2.0 * Shape{}.stature;
  const Body giant = make_body(tall);
  EXPECT_TRUE(giant.neck_from_root.isApprox(2.0 * average.neck_from_root));
  EXPECT_NEAR(giant.hand_length[1], 2.0 * average.hand_length[1], 1e-12);
}

}  // namespace
}  // namespace telemime
