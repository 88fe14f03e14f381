// SPDX-License-Identifier: Apache-2.0
#include "telemime/offline/resampler.h"

#include <gtest/gtest.h>

#include <vector>

#include "telemime/core/random.h"
#include "telemime/outputs/testing_motion.h"

namespace telemime {
namespace {

using testing_motion::frame_of;
using testing_motion::header;

MotionFrame bent(double time, double elbow) {
  const StreamHeader head = header();
  Pose pose;
  pose[Angle::l_elbow_flexion] = elbow;
  MotionFrame frame = frame_of(head.body, head.camera, pose, static_cast<std::int64_t>(time * 25.0), 25.0);
  frame.time = time;
  return frame;
}

Resampler at_25() {
  return {header().body, header().camera, 25.0};
}

std::vector<MotionFrame> pushed(Resampler& resampler, const MotionFrame& frame) {
  std::vector<MotionFrame> frames;
  resampler.push(frame, [&](const MotionFrame& made) { frames.push_back(made); });
  return frames;
}

TEST(Resampler, FramesAtTheRateStayAsTheyAre) {
  Resampler resampler = at_25();
  for (int i = 0; i < 20; ++i) {
    const MotionFrame frame = bent(7.0 + i / 25.0, -0.05 * i);
    const auto out = pushed(resampler, frame);
    ASSERT_EQ(out.size(), 1U) << i;
    EXPECT_EQ(out[0].frame, i);
    EXPECT_NEAR(out[0].time, i / 25.0, 1e-12);
    EXPECT_EQ(out[0].pose.vector(), frame.pose.vector());
  }
}

TEST(Resampler, ADroppedFrameLiesBetweenItsNeighbours) {
  Resampler resampler = at_25();
  EXPECT_EQ(pushed(resampler, bent(0.0, -0.2)).size(), 1U);
  const auto out = pushed(resampler, bent(0.08, -0.6));
  ASSERT_EQ(out.size(), 2U);
  EXPECT_EQ(out[0].state, TrackState::tracking);
  EXPECT_NEAR(out[0].pose[Angle::l_elbow_flexion], -0.4, 1e-9);
  const JointPositions joints = forward_kinematics(header().body, out[0].pose).joints;
  EXPECT_NEAR((out[0].joints[Joint::l_wrist] - joints[Joint::l_wrist]).norm(), 0.0, 1e-9);
  EXPECT_NEAR(out[1].pose[Angle::l_elbow_flexion], -0.6, 1e-12);
}

TEST(Resampler, FaceTurnsWithTheBody) {
  MotionFrame first = bent(0.0, 0.0), last = bent(0.16, 0.0);
  first.face.emplace().confidence = 0.6;
  last.face.emplace().confidence = 1.0;
  last.face->head = Eigen::AngleAxisd(0.8, Eigen::Vector3d::UnitY());
  last.face->gaze = {0.4, -0.2};
  (*last.face)[Expression::jaw_open] = 1.0;
  Resampler resampler = at_25();
  EXPECT_EQ(pushed(resampler, first).size(), 1U);
  const auto out = pushed(resampler, last);
  ASSERT_EQ(out.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    const double share = 0.25 * static_cast<double>(i + 1);
    ASSERT_TRUE(out[i].face);
    EXPECT_NEAR(out[i].face->confidence, 0.6 + 0.4 * share, 1e-9);
    EXPECT_NEAR(out[i].face->head.angularDistance(Eigen::Quaterniond::Identity()), 0.8 * share, 1e-6);
    EXPECT_NEAR(out[i].face->gaze.x(), 0.4 * share, 1e-9);
    EXPECT_NEAR((*out[i].face)[Expression::jaw_open], share, 1e-9);
  }
  // In a long gap nothing is known of the face.
  last.time = 2.0;
  const auto gap = pushed(resampler, last);
  EXPECT_FALSE(gap.front().face);
  EXPECT_TRUE(gap.back().face);
}

TEST(Resampler, AFasterCameraGivesFewerFrames) {
  Resampler resampler = at_25();
  std::size_t count = 0;
  for (int i = 0; i < 60; ++i) {
    count += pushed(resampler, bent(i / 60.0, 0.0)).size();
  }
  EXPECT_EQ(count, 25U);
}

TEST(Resampler, InALongGapThePersonIsLost) {
  Resampler resampler = at_25();
  pushed(resampler, bent(0.0, 0.0));
  const auto out = pushed(resampler, bent(2.0, -1.0));
  ASSERT_EQ(out.size(), 50U);
  EXPECT_EQ(out.front().state, TrackState::lost);
  EXPECT_EQ(out[48].state, TrackState::lost);
  EXPECT_EQ(out[49].state, TrackState::tracking);
}

TEST(Resampler, SlowPicturesAreNoGaps) {
  Resampler resampler(header().body, header().camera, 1.0);
  for (int i = 0; i < 10; ++i) {
    for (const MotionFrame& frame : pushed(resampler, bent(1.1 * i, 0.0))) {
      EXPECT_EQ(frame.state, TrackState::tracking);
    }
  }
}

TEST(Resampler, AnyTimesLastAsLongAtAnyRate) {
  Random random(5);
  for (const double fps : {5.0, 19.24, 25.0, 59.94, 240.0}) {
    Resampler resampler(header().body, header().camera, fps);
    double time = 3.0;
    std::size_t count = 0;
    for (int i = 0; i < 100; ++i) {
      for (const MotionFrame& frame : pushed(resampler, bent(time, 0.0))) {
        EXPECT_NEAR(frame.time, static_cast<double>(count++) / fps, 1e-9);
      }
      EXPECT_NEAR(static_cast<double>(count) / fps, time - 3.0 + 0.5 / fps, 0.54 / fps) << fps;
      time += 0.001 + random.uniform() * (i % 30 == 7 ? 20.0 : 0.1);
    }
  }
}

TEST(Resampler, WhoIsLostStaysLost) {
  Resampler resampler = at_25();
  MotionFrame lost = bent(0.0, 0.0);
  lost.state = TrackState::lost;
  EXPECT_EQ(pushed(resampler, lost).at(0).state, TrackState::lost);
  const auto out = pushed(resampler, bent(0.12, -1.0));
  ASSERT_EQ(out.size(), 3U);
  EXPECT_EQ(out[0].state, TrackState::lost);
  EXPECT_EQ(out[2].state, TrackState::tracking);
}

}  // namespace
}  // namespace telemime
