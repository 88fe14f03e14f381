// SPDX-License-Identifier: Apache-2.0
#include "telemime/outputs/clean_frames.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "telemime/outputs/all.h"
#include "telemime/outputs/readers/jsonl.h"
#include "telemime/outputs/testing_bap.h"
#include "telemime/outputs/testing_bvh.h"
#include "telemime/outputs/testing_motion.h"

namespace telemime {
namespace {

// A tracked frame between lost ones, each with a body, hands and a face of its own.
std::vector<MotionFrame> lost_around_tracked(const StreamHeader& header) {
  Random random(7);
  const JointLimits limits = anatomical_limits();
  std::vector<MotionFrame> frames;
  for (std::int64_t i = 0; i < 6; ++i) {
    const Pose pose = testing_motion::random_pose(limits, random);
    frames.push_back(testing_motion::frame_of(header.body, header.camera, pose, i, header.fps));
    frames.back().hands = testing_motion::random_hands(header.body, pose, random);
    frames.back().face = testing_motion::random_face(random);
    frames.back().state = i == 2 || i == 5 ? TrackState::tracking : TrackState::lost;
  }
  return frames;
}

StreamHeader header_with_fingers() {
  StreamHeader header = testing_motion::header();
  header.fingers = true;
  return header;
}

TEST(CleanFrames, ALostFrameRepeatsTheLastTrackedOne) {
  const std::vector<MotionFrame> frames = lost_around_tracked(header_with_fingers());
  CleanFrames clean;
  std::vector<MotionFrame> out;
  for (const MotionFrame& frame : frames) {
    out.push_back(clean(frame));
    EXPECT_EQ(out.back().state, frame.state);
    EXPECT_EQ(out.back().frame, frame.frame);
  }
  for (const std::size_t i : {0U, 1U, 2U, 5U}) {
    EXPECT_EQ(out[i].pose.vector(), frames[i].pose.vector()) << i << ": its own";
  }
  for (const std::size_t i : {3U, 4U}) {
    EXPECT_EQ(out[i].pose.vector(), frames[2].pose.vector()) << i;
    EXPECT_EQ(out[i].joints.at, frames[2].joints.at) << i;
    EXPECT_EQ(out[i].pixels, frames[2].pixels) << i;
    EXPECT_EQ((*out[i].hands)[0].angles, (*frames[2].hands)[0].angles) << i;
  }
}

TEST(CleanFrames, MotionFilesStandStillWhileLost) {
  const StreamHeader header = header_with_fingers();
  const std::vector<MotionFrame> frames = lost_around_tracked(header);
  const auto file = [&](const char* format) {
    return testing_motion::encode_all(*output_format(format).make({}), header, frames);
  };
  const testing_bvh::BvhFile bvh = testing_bvh::parse_bvh(file("bvh"));
  const testing_bap::BapFile bap = testing_bap::parse_bap(file("bap"));
  for (const std::size_t i : {3U, 4U}) {
    EXPECT_EQ(bvh.frames[i], bvh.frames[2]) << i;
    EXPECT_EQ(bap.frames[i].values, bap.frames[2].values) << i;
  }
  EXPECT_NE(bvh.frames[5], bvh.frames[2]);
  EXPECT_NE(bap.frames[5].values, bap.frames[2].values);
  const PoseFile poses = parse_pose_jsonl(file("jsonl"), "pose.jsonl");
  EXPECT_EQ(poses.frames[4].joints.at, poses.frames[2].joints.at);
}

}  // namespace
}  // namespace telemime
