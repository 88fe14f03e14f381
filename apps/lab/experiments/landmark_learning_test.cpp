// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/landmark_learning.h"

#include <gtest/gtest.h>

#include <cmath>

#include "telemime/body/testing_poses.h"

namespace telemime {
namespace {

// The offset that is planted: not that of the table, unless anthropometry knows it.
Eigen::Vector3d planted(std::size_t landmark) {
  if (kLandmarkPoints[landmark].source == OffsetSource::anthropometry) {
    return Eigen::Vector3d(kLandmarkPoints[landmark].offset.data());
  }
  const double side = kLandmarkPoints[landmark].name[0] == 'r' ? -1.0 : 1.0;
  return landmark == 0 ? Eigen::Vector3d(0.0, 0.03, 0.06) : Eigen::Vector3d(side * 0.02, 0.03, -0.01);
}

// What networks with the deviations of the table see of people in random poses whose landmarks are there; a
// share of them is anywhere in the picture.
std::vector<LearningFrame> made_frames(double outliers) {
  Random random(7);
  const Camera camera = camera_from_field_of_view(640, 480, 60.0);
  const JointLimits limits = anatomical_limits();
  std::vector<LearningFrame> frames(400);
  for (LearningFrame& frame : frames) {
    const Body body = make_body({});
    Pose pose = testing_poses::random_pose(limits, random);
    pose.root = {random.uniform(-0.3, 0.3), random.uniform(0.1, 0.4), random.uniform(1.6, 2.4)};
    const Kinematics k = forward_kinematics(body, pose);
    frame.camera = camera;
    LandmarkPositions points;
    for (std::size_t i = 0; i < kLandmarkCount; ++i) {
      const LandmarkPoint& point = kLandmarkPoints[i];
      frame.places[i] = {k.joints[point.origin], body.shape.stature * k[point.axes].linear()};
      points[i] = frame.places[i].origin + frame.places[i].axes * planted(i);
      const double sigma = point.sigma * camera.fx / points[i].z();
      LandmarkObservation& seen = frame.seen.points[i];
      seen.seen = true;
      seen.whitening = Eigen::Matrix2d::Identity() / sigma;
      seen.pixel = random.uniform() < outliers
                       ? Eigen::Vector2d(random.uniform(0.0, 640.0), random.uniform(0.0, 480.0))
                       : Eigen::Vector2d(camera.project(points[i]) +
                                         2.0 * sigma * Eigen::Vector2d(random.normal(), random.normal()));
    }
    frame.seen.ray = points[0].normalized();
    const auto bones = landmark_bones(points);
    for (std::size_t i = 0; i < kLandmarkBoneCount; ++i) {
      const SlopeResponse& response = kLandmarkBoneResponse[i];
      const double slope = bones[i].dot(frame.seen.ray) / bones[i].norm();
      const double along = response.offset + response.gain * slope + random.normal(0.0, 0.1);
      frame.seen.bones[i] = {
          .seen = true, .along = along, .sigma = kLandmarkBoneSigma[i], .response = response};
    }
  }
  return frames;
}

void expect_planted(const LearnedLandmarks& learned) {
  for (std::size_t i = 0; i < kLandmarkCount; ++i) {
    const double error = (Eigen::Vector3d(learned.points[i].offset.data()) - planted(i)).norm();
    EXPECT_LT(error, 0.004 + 0.1 * kLandmarkPoints[i].sigma) << kLandmarkPoints[i].name;
  }
}

TEST(LandmarkLearning, RecoversPlantedOffsets) {
  const LearnedLandmarks learned = learn_landmarks(made_frames(0.0));
  expect_planted(learned);
  for (std::size_t i = 0; i < kLandmarkCount; ++i) {
    EXPECT_NEAR(learned.points[i].sigma / kLandmarkPoints[i].sigma, 2.0, 0.2) << kLandmarkPoints[i].name;
  }
  for (const double sigma : learned.bone_sigma) {
    EXPECT_NEAR(sigma, 0.1, 0.015);
  }
}

TEST(LandmarkLearning, OutliersDoNotMoveOffsets) {
  expect_planted(learn_landmarks(made_frames(0.1)));
}

TEST(LandmarkLearning, NothingSeenKeepsTheTable) {
  const LearnedLandmarks learned = learn_landmarks({});
  for (std::size_t i = 0; i < kLandmarkCount; ++i) {
    EXPECT_EQ(learned.points[i].offset, kLandmarkPoints[i].offset) << kLandmarkPoints[i].name;
    EXPECT_EQ(learned.points[i].sigma, kLandmarkPoints[i].sigma);
  }
}

// A person whose bones are those of the model's average body stands as the model does at rest.
TEST(ActorPlaces, AgreeWithTheModelsFrames) {
  ActorPose pose;
  for (ActorArm& arm : pose.arms) {
    arm = {.upper = {0.0, -1.0, 0.0}, .fore = {0.0, -0.8, 0.6}, .pronation = 0.0, .curl = 0.0};
  }
  const LandmarkPlaces places = actor_places(actor_kinematics({}, pose));
  Pose same;
  same.root = pose.root;
  same[Angle::l_elbow_flexion] = same[Angle::r_elbow_flexion] = -std::atan2(0.6, 0.8);
  const Kinematics k = forward_kinematics(make_body({}), same);
  for (std::size_t i = 0; i < kLandmarkCount; ++i) {
    const LandmarkPoint& point = kLandmarkPoints[i];
    EXPECT_TRUE(places[i].known);
    EXPECT_LT((places[i].origin - k.joints[point.origin]).norm(), 0.09) << point.name;
    if (point.axes != Segment::l_hand && point.axes != Segment::r_hand) {
      for (Eigen::Index c = 0; c < 3; ++c) {
        EXPECT_GT(places[i].axes.col(c).normalized().dot(k[point.axes].linear().col(c)), 0.999) << point.name;
      }
    }
  }
}

}  // namespace
}  // namespace telemime
