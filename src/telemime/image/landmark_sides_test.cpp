// SPDX-License-Identifier: Apache-2.0
#include "telemime/image/landmark_sides.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace telemime {
namespace {

using Index = PoseLandmarkIndex;

constexpr double kPerMetre = 200.0;  // pixels

// A person of average size whose shoulders are turned by this angle about the vertical, with arms apart.
PoseLandmarks person(double turn, double lean = 0.0, double noise = 0.0, std::mt19937* random = nullptr) {
  PoseLandmarks landmarks;
  landmarks.next_region.width = 2.5 * 0.95 * kPerMetre;
  landmarks.next_region.height = landmarks.next_region.width;
  const auto put = [&](int left, int right, double half, double height) {
    for (const auto& [i, side] : {std::pair(left, 1.0), std::pair(right, -1.0)}) {
      PoseLandmark& point = landmarks.points[static_cast<std::size_t>(i)];
      const Eigen::Vector2d upright(side * half * std::cos(turn), -height);
      point.pixel = Eigen::Vector2d(320.0, 240.0) + kPerMetre * (Eigen::Rotation2Dd(lean) * upright);
      if (random != nullptr) {
        std::normal_distribution<double> error(0.0, noise);
        point.pixel += Eigen::Vector2d(error(*random), error(*random));
      }
      point.depth = kPerMetre * side * half * std::sin(turn);
      point.world = {side * half * std::cos(turn), -height, side * half * std::sin(turn)};
      point.visibility = side > 0.0 ? 0.9 : 0.8;
    }
  };
  put(Index::left_ear, Index::right_ear, 0.08, 0.75);
  put(Index::left_shoulder, Index::right_shoulder, 0.16, 0.5);
  put(Index::left_wrist, Index::right_wrist, 0.5, 0.2);
  put(Index::left_hip, Index::right_hip, 0.12, 0.0);
  return landmarks;
}

bool same(const PoseLandmarks& a, const PoseLandmarks& b) {
  for (std::size_t i = 0; i < PoseLandmarks::kCount; ++i) {
    if (a.points[i].pixel != b.points[i].pixel || a.points[i].world != b.points[i].world ||
        a.points[i].depth != b.points[i].depth || a.points[i].visibility != b.points[i].visibility) {
      return false;
    }
  }
  return true;
}

// In how many of the frames the sides were exchanged.
int exchanged(const std::vector<PoseLandmarks>& frames, double fps) {
  std::optional<TrunkFacing> facing;
  int count = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const PoseLandmarks out = with_steady_sides(frames[i], static_cast<double>(i) / fps, facing);
    count += same(out, frames[i]) ? 0 : 1;
  }
  return count;
}

class SteadySides : public testing::TestWithParam<double> {};

TEST_P(SteadySides, ShortExchangesAreUndone) {
  const double fps = GetParam();
  std::mt19937 random(3);
  std::optional<TrunkFacing> facing;
  for (int i = 0; i < 3 * fps; ++i) {
    const double time = i / fps;
    const PoseLandmarks truth = person(0.5 * std::sin(time), 0.8 * std::sin(2.0 * time), 2.0, &random);
    const bool wrong = std::fmod(time, 0.9) > 0.7;
    const PoseLandmarks out = with_steady_sides(wrong ? facing_other_way(truth) : truth, time, facing);
    EXPECT_TRUE(same(out, truth)) << "frame " << i;
  }
}

TEST_P(SteadySides, APirouetteIsLeftAlone) {
  const double fps = GetParam();
  for (const double speed : {-7.0, 2.0, 7.0}) {
    std::vector<PoseLandmarks> frames;
    for (int i = 0; i < 4 * fps; ++i) {
      frames.push_back(person(speed * i / fps));
    }
    EXPECT_EQ(exchanged(frames, fps), 0) << speed << " rad/s";
  }
}

TEST_P(SteadySides, WhoIsBelievedFollowsFromTimes) {
  const double fps = GetParam();
  // A long time in agreement counts half a second.
  std::vector<PoseLandmarks> frames(static_cast<std::size_t>(2 * fps), person(0.1));
  frames.resize(static_cast<std::size_t>(4 * fps), person(0.1 + std::numbers::pi));
  EXPECT_NEAR(exchanged(frames, fps) / fps, 0.5, 1.5 / fps);
}

TEST_P(SteadySides, WhoAppearsFacesTheCamera) {
  const double fps = GetParam();
  // The first third of a second was wrong.
  std::vector<PoseLandmarks> frames(static_cast<std::size_t>(2 * fps), person(0.1));
  const auto wrong = static_cast<std::size_t>(fps / 3);
  std::fill_n(frames.begin(), wrong, facing_other_way(person(0.1)));
  EXPECT_EQ(exchanged(frames, fps), static_cast<int>(wrong));
  // Somebody who turns their back is believed after half a second.
  frames.assign(static_cast<std::size_t>(2 * fps), person(0.1 + std::numbers::pi));
  EXPECT_NEAR(exchanged(frames, fps) / fps, 0.5, 1.5 / fps);
  // A person seen from the side may face either way.
  frames.assign(static_cast<std::size_t>(fps), person(0.5 * std::numbers::pi + 0.2));
  EXPECT_EQ(exchanged(frames, fps), 0);
}

INSTANTIATE_TEST_SUITE_P(FrameRates, SteadySides, testing::Values(15.0, 25.0, 60.0));

TEST(LandmarkSides, ExchangedTwiceAreTheSame) {
  const PoseLandmarks landmarks = person(0.4, 0.2);
  EXPECT_FALSE(same(facing_other_way(landmarks), landmarks));
  EXPECT_TRUE(same(facing_other_way(facing_other_way(landmarks)), landmarks));
}

TEST(LandmarkSides, AnExchangeAfterACollapseIsUndone) {
  constexpr double kFps = 60.0;
  std::vector<PoseLandmarks> frames(60, person(0.2));
  frames[40] = person(0.5 * std::numbers::pi - 0.05);  // for one frame the network sees no width
  for (std::size_t i = 41; i < 48; ++i) {
    frames[i] = facing_other_way(frames[i]);
  }
  EXPECT_EQ(exchanged(frames, kFps), 7);
}

TEST(LandmarkSides, WhereFramesAreFarApartAnythingIsPossible) {
  std::vector<PoseLandmarks> frames;
  for (int i = 0; i < 20; ++i) {
    frames.push_back(person(i % 2 == 0 ? 0.0 : std::numbers::pi));
  }
  EXPECT_EQ(exchanged(frames, 3.0), 0);
}

TEST(LandmarkSides, ATrunkWithoutLengthIsLeftAlone) {
  const std::vector<PoseLandmarks> frames(5);
  EXPECT_EQ(exchanged(frames, 25.0), 0);
}

}  // namespace
}  // namespace telemime
