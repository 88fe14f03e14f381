// SPDX-License-Identifier: Apache-2.0
#include "telemime/outputs/all.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "telemime/outputs/testing_motion.h"

namespace telemime {
namespace {

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, at);) {
    parts.push_back(part);
  }
  return parts;
}

class TrcTest : public testing::Test {
 protected:
  std::vector<std::string> lines(const std::vector<MotionFrame>& frames) const {
    return split(testing_motion::encode_all(*make_trc_encoder(), header_, frames), '\n');
  }
  StreamHeader header_ = testing_motion::header();
  std::vector<MotionFrame> frames_ = testing_motion::gesture(header_, 4);
};

constexpr std::size_t kColumns = 2 + 3 * kJointCount;

TEST_F(TrcTest, TheHeadIsThatOfTheFormat) {
  const auto text = lines(frames_);
  ASSERT_EQ(text.size(), 6U + frames_.size());
  EXPECT_EQ(text[0], "PathFileType\t4\t(X/Y/Z)\tmotion.trc");
  EXPECT_EQ(
      text[1],
      "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames");
  EXPECT_EQ(text[2], "25.000\t25.000\t4        \t12\tmm\t25.000\t1\t4        ");
  const auto names = split(text[3], '\t');
  EXPECT_EQ(names[0], "Frame#");
  EXPECT_EQ(names[1], "Time");
  const auto axes = split(text[4], '\t');
  for (std::size_t j = 0; j < kJointCount; ++j) {
    EXPECT_EQ(names[2 + 3 * j], kJointNames[j]);
    EXPECT_EQ(axes[2 + 3 * j], "X" + std::to_string(j + 1));
    EXPECT_EQ(axes[4 + 3 * j], "Z" + std::to_string(j + 1));
  }
  EXPECT_EQ(axes.size(), kColumns);
  EXPECT_EQ(text[5], "");
}

TEST_F(TrcTest, MarkersAreWhereTheJointsAre) {
  for (MotionFrame& frame : frames_) {
    frame.time += 10.0;
  }
  const auto text = lines(frames_);
  for (std::size_t f = 0; f < frames_.size(); ++f) {
    const auto cells = split(text[6 + f], '\t');
    ASSERT_EQ(cells.size(), kColumns);
    EXPECT_EQ(cells[0], std::to_string(f + 1));
    EXPECT_NEAR(std::stod(cells[1]), static_cast<double>(f) / header_.fps, 1e-6);
    for (std::size_t j = 0; j < kJointCount; ++j) {
      const Eigen::Vector3d mm(std::stod(cells[2 + 3 * j]), std::stod(cells[3 + 3 * j]),
                               std::stod(cells[4 + 3 * j]));
      const Eigen::Vector3d joint = 1000.0 * frames_[f].joints.at[j];
      EXPECT_LT((mm - Eigen::Vector3d(joint.x(), -joint.y(), -joint.z())).norm(), 0.002);
    }
  }
  // y up: the crown of a person who sits upright is above the root.
  const auto cells = split(text[6], '\t');
  const auto y_of = [&](Joint joint) { return std::stod(cells[3 + 3 * static_cast<std::size_t>(joint)]); };
  EXPECT_GT(y_of(Joint::head_top), y_of(Joint::root) + 500.0);
}

TEST_F(TrcTest, ALostFrameHasEmptyCells) {
  frames_[1].state = TrackState::lost;
  const auto text = lines(frames_);
  // Every cell ends with a tab, so that a reader counts the empty ones.
  EXPECT_EQ(text[7], "2\t0.040000\t" + std::string(3 * kJointCount, '\t'));
  EXPECT_EQ(std::count(text[6].begin(), text[6].end(), '\t'), static_cast<std::ptrdiff_t>(kColumns));
}

TEST_F(TrcTest, FingersAreMarkersWhereTheyAreSeen) {
  header_.fingers = true;
  Random random(6);
  for (MotionFrame& frame : frames_) {
    frame.hands = testing_motion::random_hands(header_.body, frame.pose, random);
    (*frame.hands)[1].visibility = 0.0;
  }
  const auto text = lines(frames_);
  const std::size_t markers = kJointCount + 2 * (kHandJointCount - 1);
  EXPECT_NE(text[2].find("\t" + std::to_string(markers) + "\tmm"), std::string::npos);
  const auto names = split(text[3], '\t');
  const std::size_t thumb = 2 + 3 * kJointCount;
  EXPECT_EQ(names[thumb], "l_hand_thumb_cmc");
  EXPECT_EQ(names[2 + 3 * (markers - 1)], "r_hand_little_tip");
  const auto cells = split(text[7], '\t');
  ASSERT_EQ(cells.size(), 2 + 3 * markers);
  for (std::size_t j = 1; j < kHandJointCount; ++j) {
    const std::size_t at = thumb + 3 * (j - 1);
    const Eigen::Vector3d mm(std::stod(cells[at]), std::stod(cells[at + 1]), std::stod(cells[at + 2]));
    const Eigen::Vector3d joint = 1000.0 * (*frames_[1].hands)[0].joints[j];
    EXPECT_LT((mm - Eigen::Vector3d(joint.x(), -joint.y(), -joint.z())).norm(), 0.002);
    EXPECT_EQ(cells[at + 3 * (kHandJointCount - 1)], "");
  }
}

TEST_F(TrcTest, NoFrameIsAFile) {
  const auto text = lines({});
  EXPECT_EQ(text.size(), 6U);
  EXPECT_NE(text[2].find("0        \t12\tmm"), std::string::npos);
}

}  // namespace
}  // namespace telemime
