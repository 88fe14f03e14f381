// SPDX-License-Identifier: Apache-2.0
#include "telemime/offline/two_way_smoothing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include "telemime/core/errors.h"
#include "telemime/core/random.h"
#include "telemime/tracker/testing_smoothing.h"

namespace telemime {
namespace {

using testing::standing;

class TwoWaySmoothingTest : public ::testing::Test, protected testing::Stage {
 protected:
  std::vector<MotionFrame> smoothed(const std::vector<MotionFrame>& frames, int look_ahead,
                                    const std::string& name = "one-euro") const {
    SmoothingOptions options;
    options.name = name;
    options.look_ahead = look_ahead;
    TwoWaySmoothing smoothing = make_two_way_smoothing(options, body, camera);
    RecordQueue queue;
    std::vector<MotionFrame> result;
    const auto collect = [&](bool last) {
      while (const auto next = smoothed_front(smoothing, queue, last)) {
        result.push_back(*next);
        queue.records.pop_front();
        --queue.smoothed;
        --queue.chosen;
      }
    };
    for (const MotionFrame& f : frames) {
      queue.records.emplace_back().estimate.motion = f;
      ++queue.chosen;
      smooth_forward(smoothing, queue);
      collect(false);
      const std::size_t late = static_cast<std::size_t>(f.frame) + 1 - result.size();
      EXPECT_LE(late, static_cast<std::size_t>(look_ahead));
    }
    collect(true);
    return result;
  }
};

// Both arms swing; the phase of what comes out tells the lag.
Pose swinging(double frame) {
  Pose pose = standing();
  const double swing = 0.8 * std::sin(2.0 * std::numbers::pi * frame / 40.0);
  pose[Angle::l_shoulder_flexion] = -0.7 + swing;
  pose[Angle::r_elbow_flexion] = -1.2 + swing;
  return pose;
}

TEST_F(TwoWaySmoothingTest, WithoutFutureItIsThePlainFilter) {
  const auto input = frames(30, swinging);
  SmoothingOptions options;
  const auto plain = make_smoother(options, body, camera);
  const auto result = smoothed(input, 0);
  ASSERT_EQ(result.size(), input.size());
  for (std::size_t t = 0; t < input.size(); ++t) {
    EXPECT_EQ(result[t].pose.vector(), (*plain)(input[t]).pose.vector()) << t;
  }
}

TEST_F(TwoWaySmoothingTest, EveryFrameComesOutOnceInOrder) {
  const auto input = frames(30, swinging);
  for (const int look_ahead : {0, 1, 12, 100}) {
    const auto result = smoothed(input, look_ahead);
    ASSERT_EQ(result.size(), input.size());
    for (std::size_t t = 0; t < input.size(); ++t) {
      EXPECT_EQ(result[t].frame, input[t].frame);
      EXPECT_EQ(result[t].time, input[t].time) << "time is never turned in what comes out";
    }
  }
}

TEST_F(TwoWaySmoothingTest, FastInputWaitsForNoMoreThanItMay) {
  SmoothingOptions options;
  TwoWaySmoothing smoothing = make_two_way_smoothing(options, body, camera);
  RecordQueue queue;
  std::size_t written = 0;
  for (MotionFrame& frame : frames(static_cast<int>(kMostWaiting) + 10, swinging)) {
    frame.time *= 0.01;  // 2500 a second
    queue.records.emplace_back().estimate.motion = frame;
    ++queue.chosen;
    smooth_forward(smoothing, queue);
    if (const auto next = smoothed_front(smoothing, queue, false)) {
      EXPECT_EQ(next->frame, static_cast<std::int64_t>(written++));
      queue.records.pop_front();
      --queue.smoothed;
      --queue.chosen;
    }
    ASSERT_LT(queue.records.size(), kMostWaiting);
  }
  EXPECT_EQ(written, 11U);
}

TEST_F(TwoWaySmoothingTest, APoseThatRestsStays) {
  const auto result = smoothed(frames(20, [](int) { return swinging(7); }), 12);
  for (const MotionFrame& f : result) {
    EXPECT_LT((f.pose.vector() - swinging(7).vector()).norm(), 1e-9);
  }
}

TEST_F(TwoWaySmoothingTest, DoesNotLag) {
  const auto input = frames(200, swinging);
  const auto error_at = [&](const std::vector<MotionFrame>& result, double shift) {
    double sum = 0.0;
    for (int t = 40; t < 160; ++t) {
      sum += std::abs(result[static_cast<std::size_t>(t)].pose[Angle::l_shoulder_flexion] -
                      swinging(t - shift)[Angle::l_shoulder_flexion]);
    }
    return sum;
  };
  for (const std::string name : {"one-euro", "recursive"}) {
    const auto one_way = smoothed(input, 0, name);
    const auto two_way = smoothed(input, 12, name);
    EXPECT_LT(error_at(one_way, 0.5), error_at(one_way, 0.0)) << name << ": the plain filter is late";
    EXPECT_LT(error_at(two_way, 0.0), error_at(two_way, 0.15)) << name;
    EXPECT_LT(error_at(two_way, 0.0), error_at(two_way, -0.15)) << name;
  }
}

TEST_F(TwoWaySmoothingTest, IsSteadierThanThePlainFilter) {
  Random random(3);
  const auto input = frames(200, [&](int) {
    Pose pose = standing();
    pose[Angle::l_shoulder_flexion] = -0.7 + random.normal(0.0, 0.03);
    return pose;
  });
  const auto jitter = [](const std::vector<MotionFrame>& f) {
    double sum = 0.0;
    for (std::size_t t = 1; t + 1 < f.size(); ++t) {
      sum += (f[t - 1].joints[Joint::l_wrist] - 2.0 * f[t].joints[Joint::l_wrist] +
              f[t + 1].joints[Joint::l_wrist])
                 .norm();
    }
    return sum;
  };
  EXPECT_LT(jitter(smoothed(input, 12)), 0.75 * jitter(smoothed(input, 0)));
}

// Rest, then a quarter of a turn of the upper arm in a fifth of a second, and rest again.
constexpr double kStrike = 0.32;  // rad, in each frame
Pose striking(int frame) {
  Pose pose = standing();
  pose[Angle::l_shoulder_flexion] = -0.4 - kStrike * std::clamp(frame - 50.0, 0.0, 5.0);
  return pose;
}

TEST_F(TwoWaySmoothingTest, FollowsAStrikeAndIsSteadyAtRest) {
  Random random(4);
  const auto input = frames(100, [&](int t) {
    Pose pose = striking(t);
    pose[Angle::l_shoulder_flexion] += random.normal(0.0, 0.03);
    return pose;
  });
  const auto result = smoothed(input, 12);
  for (std::size_t t = 0; t < result.size(); ++t) {
    const Pose truth = striking(static_cast<int>(t));
    const double error =
        std::abs(result[t].pose[Angle::l_shoulder_flexion] - truth[Angle::l_shoulder_flexion]);
    EXPECT_LT(error, t > 40 && t < 65 ? 0.5 * kStrike : 0.05)
        << t << ": late or early by less than half a frame";
  }
}

TEST_F(TwoWaySmoothingTest, TurnsBeyondHalfATurnAreFollowed) {
  const auto turning = [](int t) {
    Pose pose = standing();
    pose[Angle::root_torsion] = 0.06 * t;
    return pose;
  };
  const auto result = smoothed(frames(120, turning), 12);
  for (std::size_t t = 20; t < result.size(); ++t) {
    EXPECT_NEAR(result[t].pose[Angle::root_torsion], 0.06 * static_cast<double>(t), 0.01) << t;
  }
}

TEST_F(TwoWaySmoothingTest, LostFramesPassAndPartWhatIsBeforeFromWhatIsAfter) {
  auto input = frames(30, [](int t) {
    Pose pose = standing();
    pose.root.x() = t < 15 ? 0.0 : 0.5;
    return pose;
  });
  for (std::size_t t = 14; t < 17; ++t) {
    input[t].state = TrackState::lost;
  }
  const auto result = smoothed(input, 12);
  ASSERT_EQ(result.size(), input.size());
  for (std::size_t t = 0; t < input.size(); ++t) {
    EXPECT_EQ(result[t].state, input[t].state);
    EXPECT_NEAR(result[t].pose.root.x(), input[t].pose.root.x(), 1e-9) << t;
  }
}

TEST_F(TwoWaySmoothingTest, FramesThatAreNotFinitePass) {
  auto input = frames(10, swinging);
  input[4].pose.root.x() = std::numeric_limits<double>::quiet_NaN();
  const auto result = smoothed(input, 5);
  ASSERT_EQ(result.size(), input.size());
  for (std::size_t t = 0; t < input.size(); ++t) {
    EXPECT_EQ(result[t].pose.vector().allFinite(), t != 4) << t;
  }
}

TEST_F(TwoWaySmoothingTest, RefusesALookAheadThatCannotBe) {
  for (const int look_ahead : {-1, 251}) {
    SmoothingOptions options;
    options.look_ahead = look_ahead;
    EXPECT_THROW(make_two_way_smoothing(options, body, camera), Error) << look_ahead;
  }
}

constexpr double kDegree = std::numbers::pi / 180.0;

// Both hands as they are seen: their fingers bent by `bend` from rest; without it, not seen.
HandMotions hands_with(const std::optional<double>& bend) {
  HandMotions hands;
  for (HandMotion& hand : hands) {
    if (bend) {
      hand.visibility = 0.9;
      hand.seen = Eigen::Quaterniond::Identity();
      for (std::size_t f = 1; f < kFingerCount; ++f) {
        hand.angles[kFirstFingerAngle[f]] += *bend;
      }
    }
  }
  return hands;
}

// How far the index finger of a hand is bent from rest.
double bend_of(const MotionFrame& frame, std::size_t side) {
  return frame.hands.value()[side].angles[4] - resting_hand()[4];
}

TEST_F(TwoWaySmoothingTest, FingersAreSteadyAndFollow) {
  // Open for a second, closed within a fifth of a second, and closed.
  const auto truth = [](int t) { return 1.0 * std::clamp((t - 25) / 5.0, 0.0, 1.0); };
  Random random(5);
  auto input = frames(60, [](int) { return standing(); });
  for (MotionFrame& f : input) {
    f.hands = hands_with(truth(static_cast<int>(f.frame)));
    for (HandMotion& hand : *f.hands) {
      for (double& angle : hand.angles) {
        angle += random.normal(0.0, 5.0 * kDegree);
      }
    }
  }
  const auto result = smoothed(input, 12);
  for (std::size_t t = 0; t < result.size(); ++t) {
    const bool moves = t > 15 && t < 40;
    EXPECT_NEAR(bend_of(result[t], 0), truth(static_cast<int>(t)), (moves ? 25.0 : 8.0) * kDegree) << t;
  }
}

TEST_F(TwoWaySmoothingTest, HandsComeAndGoGently) {
  // Seen bent for a second between two in which they are not seen.
  auto input = frames(75, [](int) { return standing(); });
  for (MotionFrame& f : input) {
    f.hands = hands_with(f.frame >= 25 && f.frame < 50 ? std::optional(1.2) : std::nullopt);
  }
  const auto result = smoothed(input, 12);
  for (std::size_t t = 1; t < result.size(); ++t) {
    EXPECT_LT(std::abs(bend_of(result[t], 0) - bend_of(result[t - 1], 0)), 15.0 * kDegree) << t;
  }
  EXPECT_NEAR(bend_of(result[5], 0), 0.0, 5.0 * kDegree);
  EXPECT_NEAR(bend_of(result[37], 0), 1.2, 5.0 * kDegree);
  EXPECT_NEAR(bend_of(result.back(), 0), 0.0, 5.0 * kDegree);
}

TEST_F(TwoWaySmoothingTest, StillHandsStay) {
  auto input = frames(30, [](int) { return standing(); });
  for (MotionFrame& f : input) {
    f.hands = hands_with(0.7);
  }
  for (const MotionFrame& f : smoothed(input, 12)) {
    for (std::size_t side = 0; side < 2; ++side) {
      EXPECT_NEAR(bend_of(f, side), 0.7, 1e-9);
      EXPECT_LT(f.hands.value()[side].seen.value().angularDistance(Eigen::Quaterniond::Identity()), 1e-9);
    }
  }
}

}  // namespace
}  // namespace telemime
