// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "telemime/outputs/all.h"
#include "telemime/outputs/readers/jsonl.h"
#include "telemime/outputs/testing_motion.h"
#include "telemime/outputs/testing_mutations.h"

namespace telemime {
namespace {

TEST(ReaderRobustness, PoseJsonl) {
  const StreamHeader header = testing_motion::header();
  std::vector<MotionFrame> frames = testing_motion::gesture(header, 3);
  frames[0].spread.emplace().covariance.fill(1e-4 * Eigen::Matrix3d::Identity());
  const std::string valid = testing_motion::encode_all(*make_jsonl_encoder(), header, frames);
  testing_mutations::expect_robust(valid, [](std::string_view text) {
    for (const MotionFrame& frame : parse_pose_jsonl(text, "damaged").frames) {
      EXPECT_TRUE(frame.pose.vector().allFinite());
      EXPECT_TRUE(frame.joints[Joint::l_hand].allFinite());
    }
  });
}

}  // namespace
}  // namespace telemime
