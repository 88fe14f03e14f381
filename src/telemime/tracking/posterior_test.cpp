// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracking/posterior.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "telemime/body/testing_poses.h"
#include "telemime/tracking/testing_scene.h"

namespace telemime {
namespace {

using testing_scene::both_arms_seen;
using testing_scene::kDegree;
using testing_scene::particle;

constexpr double kRadius = 0.08;

const SpreadModel& numbers() {
  static const SpreadModel model = load_filter_model("").spread;
  return model;
}

const Body& body() {
  static const Body the_body = make_body(Shape{});
  return the_body;
}

const Camera& camera() {
  static const Camera the_camera;
  return the_camera;
}

// A pose that fits well, of a person whose size is known to `size`.
SpreadContext context(double size) {
  return {.body = body(), .camera = camera(), .size = size};
}

Pose with_left_elbow(double degrees) {
  Pose pose = both_arms_seen();
  pose[Angle::l_elbow_flexion] = degrees * kDegree;
  return pose;
}

std::size_t at(Joint joint) {
  return static_cast<std::size_t>(joint);
}

TEST(FindModes, GroupWhatIsNearTheBest) {
  const std::vector<Particle> particles = {
      particle(with_left_elbow(-20), 0.15, -1.0), particle(with_left_elbow(-100), 0.4, -5.0),
      particle(with_left_elbow(-22), 0.2, -3.0),  particle(with_left_elbow(-104), 0.2, -4.0),
      particle(with_left_elbow(-60), 0.05, -9.0),
  };
  const std::vector<Mode> modes = find_modes(body(), particles, kRadius, 10);
  ASSERT_EQ(modes.size(), 3U);
  EXPECT_EQ(modes[0].best, 1U);
  EXPECT_EQ(modes[0].likeliest, 3U);
  EXPECT_NEAR(modes[0].weight, 0.6, 1e-12);
  EXPECT_EQ(modes[1].best, 2U);
  EXPECT_EQ(modes[1].likeliest, 0U);
  EXPECT_NEAR(modes[1].weight, 0.35, 1e-12);
  EXPECT_EQ(modes[2].best, 4U);
  EXPECT_EQ(modes[2].likeliest, 4U);
  EXPECT_NEAR(modes[2].weight, 0.05, 1e-12);
  const std::vector<Mode> two = find_modes(body(), particles, kRadius, 2);
  ASSERT_EQ(two.size(), 2U);
  EXPECT_NEAR(two[1].weight, 0.35, 1e-12) << "what is over goes to none";
  EXPECT_EQ(find_modes(body(), particles, 2.0, 10).size(), 1U);
}

TEST(FindModes, EachElbowAndWristCountsAlone) {
  for (const Angle angle : {Angle::l_elbow_flexion, Angle::r_elbow_flexion, Angle::l_shoulder_twisting,
                            Angle::r_shoulder_abduct, Angle::root_torsion}) {
    Pose other = both_arms_seen();
    other[angle] += 40 * kDegree;
    const std::vector<Particle> particles = {particle(both_arms_seen(), 0.6), particle(other, 0.4)};
    EXPECT_EQ(find_modes(body(), particles, kRadius, 4).size(), 2U) << static_cast<int>(angle);
  }
  Pose nod = both_arms_seen();
  nod[Angle::neck_tilt] += 0.4;
  nod[Angle::l_wrist_flexion] += 0.4;
  const std::vector<Particle> particles = {particle(both_arms_seen(), 0.6), particle(nod, 0.4)};
  EXPECT_EQ(find_modes(body(), particles, kRadius, 4).size(), 1U) << "head and hands make no mode";
}

TEST(FindModes, WhatWeighsNothingMakesNone) {
  const std::vector<Particle> particles = {particle(with_left_elbow(-20), 1.0),
                                           particle(with_left_elbow(-100), 0.0)};
  EXPECT_EQ(find_modes(body(), particles, kRadius, 4).size(), 1U);
  EXPECT_TRUE(find_modes(body(), {}, kRadius, 4).empty());
}

TEST(SpreadOf, OneParticleLeavesWhatTheModelDoesNotKnow) {
  const std::vector<Particle> one = {particle(both_arms_seen(), 1.0)};
  const PoseSpread spread = spread_of(context(0.05), one, both_arms_seen(), numbers());
  const auto model = model_covariance(context(0.05), both_arms_seen(), numbers());
  for (std::size_t j = 0; j < kJointCount; ++j) {
    EXPECT_EQ(spread.covariance[j], model[j]) << kJointNames[j];
  }
  EXPECT_EQ(spread.second_mode, 0.0);
  EXPECT_DOUBLE_EQ(spread.effective_particles, 1.0);
}

TEST(SpreadOf, TwoParticlesAddHalfTheirDistance) {
  const Pose middle = with_left_elbow(-60);
  const std::vector<Particle> two = {particle(with_left_elbow(-75), 0.5),
                                     particle(with_left_elbow(-45), 0.5)};
  const PoseSpread spread = spread_of(context(0.05), two, middle, numbers());
  const auto model = model_covariance(context(0.05), middle, numbers());
  const auto wrist = [](const Pose& pose) { return forward_kinematics(body(), pose).joints[Joint::l_wrist]; };
  const Eigen::Vector3d way = wrist(two[1].pose) - wrist(two[0].pose);
  const double a = 0.5 * way.norm();
  const Eigen::Vector3d along = way.normalized();
  const Eigen::Matrix3d added = spread.covariance[at(Joint::l_wrist)] - model[at(Joint::l_wrist)];
  ASSERT_GT(a, 0.03);
  // The wrist moves along an arc whose middle is the estimate.
  EXPECT_NEAR(along.dot(added * along), a * a, 1e-12);
  const Eigen::Vector3d bow = wrist(middle) - 0.5 * (wrist(two[0].pose) + wrist(two[1].pose));
  EXPECT_NEAR(added.trace(), a * a + bow.squaredNorm(), 1e-12);
  EXPECT_EQ(spread.covariance[at(Joint::r_wrist)], model[at(Joint::r_wrist)]);
  EXPECT_EQ(spread.covariance[at(Joint::l_elbow)], model[at(Joint::l_elbow)]);
  EXPECT_DOUBLE_EQ(spread.effective_particles, 2.0);
}

TEST(SpreadOf, IsSeenFromTheMiddleOfTheShoulders) {
  Pose near = both_arms_seen();
  Pose far = both_arms_seen();
  near.root.z() -= 0.1;
  far.root.z() += 0.1;
  const std::vector<Particle> two = {particle(near, 0.5), particle(far, 0.5)};
  const PoseSpread spread = spread_of(context(0.05), two, both_arms_seen(), numbers());
  const auto model = model_covariance(context(0.05), both_arms_seen(), numbers());
  for (std::size_t j = 0; j < kJointCount; ++j) {
    EXPECT_LT((spread.covariance[j] - model[j]).norm(), 1e-12) << kJointNames[j];
  }
}

TEST(SpreadOf, TellsTheWeightOfTheSecondMode) {
  const std::vector<Particle> particles = {particle(with_left_elbow(-20), 0.3),
                                           particle(with_left_elbow(-100), 0.6),
                                           particle(with_left_elbow(-60), 0.1)};
  const PoseSpread spread = spread_of(context(0.05), particles, with_left_elbow(-100), numbers());
  EXPECT_NEAR(spread.second_mode, 0.3, 1e-12);
}

TEST(SpreadOf, IsSymmetricAndPositiveDefinite) {
  const JointLimits limits = anatomical_limits();
  Random random(1);
  for (int i = 0; i < 100; ++i) {
    std::vector<Particle> particles;
    for (int k = 0; k < 5; ++k) {
      particles.push_back(particle(testing_poses::random_pose(limits, random), 0.2));
    }
    const PoseSpread spread = spread_of(context(0.05), particles, particles[0].pose, numbers());
    for (std::size_t j = 0; j < kJointCount; ++j) {
      const Eigen::Matrix3d& c = spread.covariance[j];
      ASSERT_TRUE(c.allFinite());
      ASSERT_LT((c - c.transpose()).cwiseAbs().maxCoeff(), 1e-15);
      const Eigen::LLT<Eigen::Matrix3d> factor(c);
      ASSERT_EQ(factor.info(), Eigen::Success) << kJointNames[j];
      ASSERT_GT(factor.matrixL().determinant(), 0.0) << kJointNames[j];
    }
  }
}

// The left upper arm at this angle (rad) to the image plane, towards the camera.
Pose upper_arm_raised(double angle) {
  const Pose pose = both_arms_seen();
  const Eigen::Vector3d ray = forward_kinematics(body(), pose).joints[Joint::l_shoulder].normalized();
  const Eigen::Vector3d side = Eigen::Vector3d::UnitY().cross(ray).normalized();  // the person's left
  const Eigen::Vector3d direction = std::cos(angle) * side - std::sin(angle) * ray;
  const Eigen::Vector3d shoulder = forward_kinematics(body(), pose).joints[Joint::l_shoulder];
  const Eigen::Vector3d elbow = shoulder + body().upper_arm_length[0] * direction;
  Pose raised = pose;
  set_arm_angles(raised, Side::left,
                 arm_through(body(), pose, Side::left, elbow, elbow + 0.2 * Eigen::Vector3d::UnitY(),
                             anatomical_limits()));
  return raised;
}

// m^2: what the upper arm adds to its elbow's variance in depth.
double depth_of_elbow(const Pose& pose) {
  const auto covariance = model_covariance(context(0.0), pose, numbers());
  const Eigen::Vector3d ray = forward_kinematics(body(), pose).joints[Joint::l_shoulder].normalized();
  return ray.dot((covariance[at(Joint::l_elbow)] - covariance[at(Joint::l_shoulder)]) * ray);
}

TEST(ModelCovariance, ABoneParallelToTheImageIsLessSureInDepth) {
  const double length = body().upper_arm_length[0];
  const double seen = numbers().seen;
  const double flat = depth_of_elbow(upper_arm_raised(0.0));
  const double slanted = depth_of_elbow(upper_arm_raised(45 * kDegree));
  EXPECT_GT(flat, 1.5 * slanted);
  // The shoulder moves a little with the arm, so that the angles are not exact.
  EXPECT_NEAR(std::sqrt(flat), std::sqrt(seen / 2.0) * length, 0.02 * length);
  EXPECT_NEAR(std::sqrt(slanted), seen * length / std::sqrt(0.5 + 2.0 * seen), 0.02 * length);
}

TEST(ModelCovariance, TheTrunkIsKnownAsWellAsTheNumbersSay) {
  const auto covariance = model_covariance(context(0.0), both_arms_seen(), numbers());
  const JointPositions joints = forward_kinematics(body(), both_arms_seen()).joints;
  const Eigen::Vector3d middle = mid_shoulders(joints);
  const double trunk = numbers().trunk * numbers().trunk;
  for (const Joint j : {Joint::l_shoulder, Joint::r_shoulder}) {
    EXPECT_LT((covariance[at(j)] - trunk * Eigen::Matrix3d::Identity()).norm(), 1e-15);
  }
  for (const Joint j : {Joint::neck, Joint::head, Joint::head_top, Joint::root}) {
    const double way = numbers().lean * (joints[j] - middle).norm();
    EXPECT_LT((covariance[at(j)] - (trunk + way * way) * Eigen::Matrix3d::Identity()).norm(), 1e-15);
  }
}

TEST(ModelCovariance, AWristMaySlideAlongItsForearm) {
  SpreadModel still = numbers();
  still.slide = 0.0;
  SpreadModel sliding = numbers();
  sliding.slide = 0.03;
  const auto without = model_covariance(context(0.0), both_arms_seen(), still);
  const auto with = model_covariance(context(0.0), both_arms_seen(), sliding);
  const JointPositions joints = forward_kinematics(body(), both_arms_seen()).joints;
  for (const auto& [elbow, wrist, hand] : {std::array{Joint::l_elbow, Joint::l_wrist, Joint::l_hand},
                                           std::array{Joint::r_elbow, Joint::r_wrist, Joint::r_hand}}) {
    const Eigen::Vector3d forearm = (joints[wrist] - joints[elbow]).normalized();
    const Eigen::Matrix3d more = 0.03 * 0.03 * forearm * forearm.transpose();
    EXPECT_LT((with[at(wrist)] - without[at(wrist)] - more).norm(), 1e-15);
    EXPECT_LT((with[at(hand)] - without[at(hand)] - more).norm(), 1e-15) << "the hand goes with it";
    EXPECT_EQ(with[at(elbow)], without[at(elbow)]);
  }
}

TEST(ModelCovariance, GrowsFromTheShoulderToTheHand) {
  const auto covariance = model_covariance(context(0.0), both_arms_seen(), numbers());
  for (const auto& [from, to] :
       {std::pair{Joint::l_shoulder, Joint::l_elbow}, std::pair{Joint::l_elbow, Joint::l_wrist},
        std::pair{Joint::l_wrist, Joint::l_hand}, std::pair{Joint::r_shoulder, Joint::r_elbow},
        std::pair{Joint::r_elbow, Joint::r_wrist}, std::pair{Joint::r_wrist, Joint::r_hand}}) {
    const Eigen::Matrix3d more = covariance[at(to)] - covariance[at(from)];
    EXPECT_EQ(Eigen::LLT<Eigen::Matrix3d>(more).info(), Eigen::Success) << kJointNames[at(to)];
  }
}

TEST(ModelCovariance, UnknownSizeWidensAwayFromTheShoulders) {
  const auto known = model_covariance(context(0.0), both_arms_seen(), numbers());
  const auto unsure = model_covariance(context(0.1), both_arms_seen(), numbers());
  const JointPositions joints = forward_kinematics(body(), both_arms_seen()).joints;
  const Eigen::Vector3d middle = mid_shoulders(joints);
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const Eigen::Vector3d way = joints.at[j] - middle;
    const Eigen::Matrix3d more = unsure[j] - known[j];
    EXPECT_NEAR(way.normalized().dot(more * way.normalized()), 0.01 * way.squaredNorm(), 1e-12);
    EXPECT_NEAR(more.trace(), 0.01 * way.squaredNorm(), 1e-12) << "nothing across it";
  }
}

TEST(ModelCovariance, OfAPoorFitIsWiderBySquares) {
  const auto good = model_covariance({.body = body(), .camera = camera(), .region = numbers().residual},
                                     both_arms_seen(), numbers());
  const auto poor = model_covariance({.body = body(), .camera = camera(), .region = 2.0 * numbers().residual},
                                     both_arms_seen(), numbers());
  const auto better = model_covariance({.body = body(), .camera = camera()}, both_arms_seen(), numbers());
  const auto held = model_covariance(
      {.body = body(), .camera = camera(), .region = 2.0 * numbers().residual, .landmarks = true},
      both_arms_seen(), numbers());
  for (std::size_t j = 0; j < kJointCount; ++j) {
    EXPECT_LT((poor[j] - 16.0 * good[j]).norm(), 1e-12) << kJointNames[j];
    EXPECT_LT((held[j] - 2.0 * good[j]).norm(), 1e-12) << kJointNames[j];
    EXPECT_LT((better[j] - good[j]).norm(), 1e-12) << kJointNames[j];
  }
}

TEST(ModelCovariance, OfWhatIsOutsideThePictureIsWide) {
  const Pose inside = both_arms_seen();
  const auto seen = model_covariance(context(0.0), inside, numbers());
  const JointPositions joints = forward_kinematics(body(), inside).joints;
  Camera narrow = camera();
  narrow.cx += narrow.width - 1.0 -
               (0.9 * camera().project(joints[Joint::l_wrist]).x() +
                0.1 * camera().project(joints[Joint::l_hand]).x());
  ASSERT_GT(narrow.project(joints[Joint::l_hand]).x(), narrow.width);
  ASSERT_LT(narrow.project(joints[Joint::l_wrist]).x(), narrow.width - 1.0);
  const auto cut = model_covariance({.body = body(), .camera = narrow}, inside, numbers());
  EXPECT_GT(cut[at(Joint::l_hand)].trace(), 2.0 * seen[at(Joint::l_hand)].trace());
  EXPECT_GT(cut[at(Joint::l_wrist)].trace(), 1.5 * seen[at(Joint::l_wrist)].trace());
  EXPECT_LT((cut[at(Joint::l_elbow)] - seen[at(Joint::l_elbow)]).norm(), 1e-12);
  EXPECT_LT((cut[at(Joint::r_hand)] - seen[at(Joint::r_hand)]).norm(), 1e-12);
}

TEST(ModelCovariance, ABoneThatIsCutOffShowsItsDirection) {
  const Pose pose = both_arms_seen();
  const JointPositions joints = forward_kinematics(body(), pose).joints;
  const Eigen::Vector3d& shoulder = joints[Joint::l_shoulder];
  const Eigen::Vector3d& elbow = joints[Joint::l_elbow];
  const double length = (elbow - shoulder).norm();
  const Eigen::Vector3d ray = shoulder.normalized();
  const Eigen::Vector3d across = ray.cross(elbow - shoulder).normalized();
  // Cameras whose lower border cuts the upper arm at a share of it.
  const auto deviations = [&](double share) {
    Camera cut = camera();
    const double from = cut.project(shoulder).y();
    const double to = cut.project(elbow).y();
    cut.height = static_cast<int>(std::lround(from + share * (to - from) + 0.5));
    const auto covariance = model_covariance({.body = body(), .camera = cut}, pose, numbers());
    const Eigen::Matrix3d added = covariance[at(Joint::l_elbow)] - covariance[at(Joint::l_shoulder)];
    return std::pair(std::sqrt(across.dot(added * across)), std::sqrt(ray.dot(added * ray)));
  };
  const auto [wide, deep] = deviations(0.05);
  const auto [half, half_deep] = deviations(0.5);
  const auto [most, most_deep] = deviations(0.9);
  EXPECT_NEAR(wide, 0.5 * length, 1e-9) << "too little is seen";
  EXPECT_LT(half, 0.3 * length);
  EXPECT_LT(most, 0.65 * half);
  for (const double depth : {deep, half_deep, most_deep}) {
    EXPECT_NEAR(depth, 0.5 * length, 1e-9) << "a bone without its end shows no depth";
  }
}

TEST(ModelCovariance, OfAnArmInOneColourIsWider) {
  Shape sleeves;
  sleeves.sleeve = 2.0;
  const Body covered = make_body(sleeves);
  const auto bare = model_covariance(context(0.0), both_arms_seen(), numbers());
  const auto dressed = model_covariance({.body = covered, .camera = camera()}, both_arms_seen(), numbers());
  for (const Joint j : {Joint::l_elbow, Joint::r_wrist}) {
    EXPECT_GT(dressed[at(j)].trace(), 1.5 * bare[at(j)].trace());
  }
  EXPECT_LT((dressed[at(Joint::neck)] - bare[at(Joint::neck)]).norm(), 1e-15);
}

TEST(ModelCovariance, DepthErrorsAlongAStraightArmAddUp) {
  // Both bones point the same way: their contributions along the ray add linearly.
  const Pose straight = with_left_elbow(0.0);
  const auto covariance = model_covariance(context(0.0), straight, numbers());
  const JointPositions joints = forward_kinematics(body(), straight).joints;
  const Eigen::Vector3d ray = joints[Joint::l_elbow].normalized();
  const auto along = [&](Joint j) {
    return std::sqrt(ray.dot((covariance[at(j)] - covariance[at(Joint::l_shoulder)]) * ray));
  };
  const double lengths = (body().upper_arm_length[0] + body().forearm_length[0]) / body().upper_arm_length[0];
  EXPECT_NEAR(along(Joint::l_wrist) / along(Joint::l_elbow), lengths, 0.15 * lengths);
}

}  // namespace
}  // namespace telemime
