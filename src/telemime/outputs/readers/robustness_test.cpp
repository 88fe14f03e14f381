// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "telemime/outputs/all.h"
#include "telemime/outputs/bap/reader.h"
#include "telemime/outputs/bvh/bvh.h"
#include "telemime/outputs/readers/jsonl.h"
#include "telemime/outputs/testing_motion.h"
#include "telemime/outputs/testing_mutations.h"

namespace telemime {
namespace {

std::string valid_file(std::string_view format) {
  const StreamHeader header = testing_motion::header();
  std::vector<MotionFrame> frames = testing_motion::gesture(header, 3);
  PoseSpread spread;
  spread.covariance.fill(1e-4 * Eigen::Matrix3d::Identity());
  frames[0].spread = spread;
  return testing_motion::encode_all(*output_format(format).make({}), header, frames);
}

TEST(ReaderRobustness, PoseJsonl) {
  testing_mutations::expect_robust(valid_file("jsonl"), [](std::string_view text) {
    for (const MotionFrame& frame : parse_pose_jsonl(text, "damaged").frames) {
      EXPECT_TRUE(frame.pose.vector().allFinite());
      EXPECT_TRUE(frame.joints[Joint::l_hand].allFinite());
    }
  });
}

TEST(ReaderRobustness, Bvh) {
  testing_mutations::expect_robust(valid_file("bvh"), [](std::string_view text) {
    const BvhFile file = parse_bvh(text, "damaged");
    for (std::size_t f = 0; f < file.frames.size(); ++f) {
      EXPECT_EQ(bvh_world(file, f).size(), file.joints.size());
    }
  });
}

TEST(ReaderRobustness, Bap) {
  const BapProfile& profile = bap_profile("iso");
  testing_mutations::expect_robust(valid_file("bap"), [&profile](std::string_view text) {
    BapValues values{};
    for (const BapFrame& frame : parse_bap(text, "damaged").frames) {
      values = values_of(profile, frame, values);
      EXPECT_TRUE(decode_bap(profile, values, Pose{}).vector().allFinite());
    }
  });
}

}  // namespace
}  // namespace telemime
