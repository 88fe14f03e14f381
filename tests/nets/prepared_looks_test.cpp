// SPDX-License-Identifier: Apache-2.0
// Looks at the places where hands and face were may be prepared before the pose of the body is known.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "support/needs.h"
#include "telemime/capture/source.h"
#include "telemime/image/face_finder.h"
#include "telemime/image/hand_finder.h"
#include "telemime/nets/find_pose.h"

namespace telemime {
namespace {

const std::filesystem::path kModels = TELEMIME_BUILD_MODELS;
constexpr double kFrame = 0.04;  // s

class PreparedLooks : public support::WithNetworks {
 protected:
  void SetUp() override {
    WithNetworks::SetUp();
    if (IsSkipped()) {
      return;
    }
    constexpr std::size_t kFrames = 6;
    const std::unique_ptr<Source> source = open_source(TELEMIME_SOURCE_DIR "/data/demo/video.mp4");
    PoseNetworks networks = load_pose_networks(kModels);
    for (auto frame = source->next(); frame && pictures_.size() < kFrames; frame = source->next()) {
      pictures_.push_back(frame->image.clone());
      const std::optional<PoseLandmarks> pose = find_pose(pictures_.back(), networks);
      ASSERT_TRUE(pose);
      poses_.push_back(*pose);
    }
    ASSERT_EQ(pictures_.size(), kFrames);
  }

  static double time_of(std::size_t frame) { return kFrame * static_cast<double>(frame); }
  cv::Mat blank() const { return cv::Mat(pictures_[0].size(), CV_8UC3, cv::Scalar(90, 90, 90)); }
  cv::Size size() const { return pictures_[0].size(); }

  std::vector<cv::Mat> pictures_;
  std::vector<PoseLandmarks> poses_;
};

bool have_equal_pixels(const auto& a, const auto& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const auto& p, const auto& q) { return p.pixel == q.pixel; });
}

bool are_equal(const std::optional<HandLandmarks>& a, const std::optional<HandLandmarks>& b) {
  return a.has_value() == b.has_value() && (!a || have_equal_pixels(a->points, b->points));
}

bool are_equal(const std::optional<FaceLandmarks>& a, const std::optional<FaceLandmarks>& b) {
  return a.has_value() == b.has_value() &&
         (!a || (have_equal_pixels(a->points, b->points) && a->again.has_value() == b->again.has_value() &&
                 (!a->again || have_equal_pixels(*a->again, *b->again))));
}

TEST_F(PreparedLooks, HandsAreTheSame) {
  for (const bool in_turn : {false, true}) {
    HandFinder prepared(kModels);
    HandFinder plain(kModels);
    int found = 0;
    for (std::size_t i = 0; i < pictures_.size(); ++i) {
      prepared.prepare(pictures_[i], time_of(i), in_turn);
      const auto a = prepared.find(pictures_[i], poses_[i], size(), time_of(i), in_turn);
      const auto b = plain.find(pictures_[i], poses_[i], size(), time_of(i), in_turn);
      for (std::size_t hand = 0; hand < 2; ++hand) {
        EXPECT_EQ(a[hand].looked, b[hand].looked);
        EXPECT_TRUE(are_equal(a[hand].found, b[hand].found)) << "frame " << i;
        found += b[hand].found ? 1 : 0;
      }
    }
    EXPECT_GE(found, 3);
  }
}

TEST_F(PreparedLooks, FaceIsTheSame) {
  FaceFinder prepared(kModels);
  FaceFinder plain(kModels);
  for (std::size_t i = 0; i < pictures_.size(); ++i) {
    prepared.prepare(pictures_[i], time_of(i));
    const auto a = prepared.find(pictures_[i], poses_[i], size(), time_of(i));
    const auto b = plain.find(pictures_[i], poses_[i], size(), time_of(i));
    EXPECT_TRUE(b && are_equal(a, b)) << "frame " << i;
  }
}

TEST_F(PreparedLooks, AreUsedForTheirTimeAlone) {
  HandFinder hands(kModels);
  FaceFinder faces(kModels);
  const auto hands_before = hands.find(pictures_[0], poses_[0], size(), time_of(0));
  ASSERT_TRUE(hands_before[0].found || hands_before[1].found);
  ASSERT_TRUE(faces.find(pictures_[0], poses_[0], size(), time_of(0)));
  const auto looks = [&](double prepared_for) {
    HandFinder own_hands = hands;
    FaceFinder own_faces = faces;
    own_hands.prepare(blank(), prepared_for);
    own_faces.prepare(blank(), prepared_for);
    return std::pair(own_hands.find(pictures_[1], poses_[1], size(), time_of(1)),
                     own_faces.find(pictures_[1], poses_[1], size(), time_of(1)));
  };
  // Who was shown a blank picture must look elsewhere: at the squares that the pose or the detector gives.
  const auto used = looks(time_of(1));
  const auto unused = looks(time_of(2));
  const auto plain_hands = HandFinder(hands).find(pictures_[1], poses_[1], size(), time_of(1));
  const auto plain_face = FaceFinder(faces).find(pictures_[1], poses_[1], size(), time_of(1));
  EXPECT_FALSE(are_equal(used.second, plain_face));
  EXPECT_TRUE(are_equal(unused.second, plain_face));
  bool hand_differs = false;
  for (std::size_t hand = 0; hand < 2; ++hand) {
    hand_differs = hand_differs || !are_equal(used.first[hand].found, plain_hands[hand].found);
    EXPECT_TRUE(are_equal(unused.first[hand].found, plain_hands[hand].found));
  }
  EXPECT_TRUE(hand_differs);
}

}  // namespace
}  // namespace telemime
