// SPDX-License-Identifier: Apache-2.0
#include "lab/synth/actor.h"

// boost/math/interpolators/pchip.hpp of Boost 1.74 calls isnan() without std.
#include <math.h>

#include <algorithm>
#include <boost/math/interpolators/pchip.hpp>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "telemime/core/errors.h"
#include "telemime/core/random.h"
#include "telemime/core/text.h"

namespace telemime {
namespace {

// Directions: outward, up, forward. Then pronation and extension in degrees, curl.
constexpr GestureArmKey kRest = {{0.42, -0.90, 0.03}, {0.74, -0.41, 0.38}, 55, 0, 0.32};

constexpr GestureKey both(double frame, const GestureArmKey& arm, double lean, double nod) {
  return {frame, arm, arm, lean, nod};
}

constexpr GestureArmKey kOpenLow = {{0.82, -0.55, 0.08}, {0.84, 0.22, 0.30}, 50, -8, 0.25};
constexpr GestureArmKey kOpenHigh = {{0.96, -0.10, 0.10}, {0.50, 0.84, 0.16}, 15, 0, 0.15};
constexpr GestureArmKey kUp = {{0.60, 0.78, 0.10}, {0.12, 0.98, 0.14}, 5, 5, 0.10};
constexpr GestureArmKey kUpWide = {{0.76, 0.62, 0.12}, {0.34, 0.93, 0.16}, 10, 10, 0.12};
constexpr std::array<GestureKey, 10> kRaisingArms = {{
    both(0, kRest, 0, 0),
    both(10, kRest, 0, 0),
    both(30, kOpenLow, 0, 0),
    both(48, kOpenHigh, -1, -2),
    {72, kUp, kUpWide, -2, -6},
    {90, kUpWide, kUp, -2, -6},
    both(108, kOpenLow, 0, 0),
    {126, kOpenHigh, {{0.94, -0.25, 0.10}, {0.62, 0.74, 0.20}, 20, 0, 0.2}, -1, -1},
    {139, {{0.88, 0.32, 0.10}, {0.15, 0.97, 0.18}, 5, 5, 0.1}, kOpenHigh, -1, -3},
    both(164, kRest, 0, 0),
}};

constexpr GestureArmKey kReach = {{0.52, -0.02, 0.85}, {0.10, 0.72, 0.66}, 20, 10, 0.2};
constexpr GestureArmKey kCheer = {{0.66, 0.30, 0.68}, {-0.02, 0.92, 0.38}, 10, 5, 0.12};
constexpr GestureArmKey kCheerHigh = {{0.66, 0.52, 0.54}, {-0.04, 0.96, 0.26}, 5, 5, 0.1};
constexpr GestureArmKey kDropped = {{0.30, -0.84, 0.44}, {-0.30, 0.38, 0.86}, 60, 5, 0.35};
constexpr GestureArmKey kFace = {{0.30, -0.45, 0.84}, {-0.46, 0.86, -0.06}, -35, -10, 0.30};
constexpr std::array<GestureKey, 12> kJoy = {{
    both(0, kRest, 0, 0),
    both(10, kRest, 0, 0),
    both(30, kReach, -1, -2),
    both(46, kCheer, -3, -7),
    both(64, kCheerHigh, -3, -8),
    both(69, kCheerHigh, -3, -7),
    both(77, kDropped, 2, 2),
    both(86, kCheerHigh, -3, -8),
    both(100, kCheer, -2, -5),
    {118, kFace, {{0.27, -0.42, 0.85}, {-0.44, 0.87, -0.10}, -35, -10, 0.35}, 1, 3},
    {136, {{0.27, -0.48, 0.82}, {-0.48, 0.84, -0.04}, -40, -10, 0.30}, kFace, 1, 4},
    both(164, kRest, 0, 0),
}};

constexpr GestureArmKey kStopLow = {{0.38, -0.90, 0.18}, {-0.05, 0.28, 0.95}, 85, 62, 0.12};
constexpr GestureArmKey kStopThrust = {{0.34, -0.58, 0.74}, {-0.04, 0.34, 0.93}, 85, 66, 0.08};
constexpr GestureArmKey kStopHigh = {{0.48, -0.44, 0.74}, {0.14, 0.78, 0.60}, 60, 35, 0.12};
constexpr GestureArmKey kTurnedOut = {{0.84, -0.46, 0.28}, {0.42, 0.82, 0.40}, 25, 15, 0.15};
constexpr GestureArmKey kTurnedIn = {{0.52, -0.52, 0.68}, {-0.58, 0.50, 0.62}, 45, 5, 0.25};
constexpr GestureArmKey kCross = {{0.22, -0.80, 0.56}, {-0.82, 0.36, 0.42}, 50, 0, 0.25};
constexpr GestureArmKey kRaisedHand = {{0.50, -0.34, 0.80}, {0.08, 0.96, 0.24}, 30, 10, 0.15};
constexpr GestureArmKey kLowHand = {{0.42, -0.88, 0.20}, {0.22, 0.16, 0.96}, 30, 10, 0.3};
constexpr std::array<GestureKey, 12> kExclaiming = {{
    both(0, kRest, 0, 0),
    both(8, kRest, 0, 0),
    both(28, kStopLow, 2, 1),
    both(43, kStopThrust, 4, 2),
    both(58, kStopHigh, 0, -1),
    both(74, kTurnedOut, -2, -3),
    both(89, kTurnedIn, 0, 0),
    {104, kRaisedHand, kTurnedIn, 0, 0},
    {118, kRaisedHand, kCross, 1, 2},
    {133, kCross, kLowHand, 1, 2},
    {147, kTurnedIn, kLowHand, 0, 1},
    both(164, kRest, 0, 0),
}};

constexpr GestureArmKey kPalmsLow = {{0.26, -0.94, 0.20}, {0.22, -0.06, 0.97}, -70, 0, 0.25};
constexpr GestureArmKey kThrust = {{0.30, -0.70, 0.64}, {0.18, 0.02, 0.98}, -75, 8, 0.12};
constexpr GestureArmKey kThrustFar = {{0.26, -0.52, 0.81}, {0.20, 0.04, 0.97}, -80, 12, 0.08};
constexpr GestureArmKey kRetract = {{0.30, -0.95, -0.12}, {0.34, 0.44, 0.83}, -60, -5, 0.30};
constexpr GestureArmKey kOpen = {{0.46, -0.76, 0.46}, {0.48, 0.16, 0.86}, -75, 5, 0.18};
constexpr GestureArmKey kOpenBack = {{0.48, -0.86, 0.16}, {0.66, 0.32, 0.68}, -65, 0, 0.25};
constexpr std::array<GestureKey, 13> kAsking = {{
    both(0, kRest, 0, 0),
    both(8, kRest, 0, 0),
    both(27, kPalmsLow, 1, 1),
    both(43, kThrust, 4, 0),
    both(58, kRetract, -3, -1),
    {73, kOpen, kThrust, 2, -2},
    {86, kThrust, kOpen, 2, -2},
    both(95, kThrust, 3, -1),
    both(101, kRetract, -3, 0),
    both(107, kThrustFar, 6, -1),
    both(122, kThrustFar, 5, -2),
    both(138, kOpenBack, -1, -1),
    both(164, kRest, 0, 0),
}};

constexpr GestureArmKey kLap = {{0.30, -0.95, 0.10}, {-0.30, -0.30, 0.90}, 60, 0, 0.40};
constexpr GestureArmKey kTalkLow = {{0.34, -0.92, 0.20}, {0.05, 0.25, 0.95}, 20, 5, 0.30};
constexpr GestureArmKey kTalkOpen = {{0.42, -0.86, 0.28}, {0.40, 0.35, 0.85}, -20, 5, 0.20};
constexpr GestureArmKey kTalkIn = {{0.30, -0.88, 0.38}, {-0.40, 0.45, 0.80}, 35, 0, 0.30};
constexpr GestureArmKey kTalkPoint = {{0.34, -0.80, 0.50}, {0.05, 0.62, 0.78}, 30, 5, 0.55};
constexpr GestureArmKey kClasp = {{0.28, -0.92, 0.28}, {-0.50, 0.15, 0.85}, 50, 0, 0.35};
constexpr std::array<GestureKey, 11> kTalking = {{
    both(0, kRest, 0, 0),
    both(10, kRest, 0, 0),
    both(30, kTalkLow, 1, 0),
    {48, kTalkOpen, kTalkLow, 2, -1},
    {66, kTalkIn, kTalkOpen, 2, 1},
    {84, kTalkLow, kTalkPoint, 1, -1},
    both(100, kClasp, 0, 1),
    {118, kTalkPoint, kTalkLow, 2, -1},
    both(136, kLap, -1, 1),
    both(150, kLap, -1, 0),
    both(164, kRest, 0, 0),
}};

struct GestureData {
  std::span<const GestureKey> keys;
  std::string_view note;
};

// By Gesture.
constexpr std::array<GestureData, kGestureCount> kGestures = {{
    {kRaisingArms, "arms raised and lowered beside the body, mostly parallel to the image"},
    {kJoy, "arms up and forward, one fast drop and raise, then hands before the face"},
    {kExclaiming, "hands toward the camera, upper arms rotate, forearms cross the chest"},
    {kAsking, "palms up, forearms far forward and back, one fast retract and thrust"},
    {kTalking, "slow talking gestures before the trunk, hands in the lap between them"},
}};

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr std::size_t kNumbers = 11;  // of one arm (9), lean, nod
using Numbers = std::array<double, kNumbers>;

Numbers numbers_of(const GestureKey& key, std::size_t side) {
  const GestureArmKey& a = side == 0 ? key.left : key.right;
  return {a.upper[0],  a.upper[1],  a.upper[2], a.fore[0], a.fore[1], a.fore[2],
          a.pronation, a.extension, a.curl,     key.lean,  key.nod};
}

Numbers numbers_at(std::span<const GestureKey> keys, double frame, std::size_t side) {
  frame = std::clamp(frame, keys.front().frame, keys.back().frame);
  Numbers result{};
  for (std::size_t k = 0; k < kNumbers; ++k) {
    std::vector<double> frames;
    std::vector<double> values;
    for (const GestureKey& key : keys) {
      frames.push_back(key.frame);
      values.push_back(numbers_of(key, side)[k]);
    }
    // It rests at both ends.
    const boost::math::interpolators::pchip<std::vector<double>> curve(std::move(frames), std::move(values),
                                                                       0.0, 0.0);
    result[k] = curve(frame);
  }
  return result;
}

// A slow drift in [-1, 1]: two sines with unrelated periods (s) and random phases.
struct Drift {
  double period1, period2, phase1, phase2;
  explicit Drift(Random& random)
      : period1(random.uniform(2.2, 4.5)),
        period2(random.uniform(0.9, 1.8)),
        phase1(random.uniform(0.0, 2.0 * std::numbers::pi)),
        phase2(random.uniform(0.0, 2.0 * std::numbers::pi)) {}
  double at(double time) const {
    return 0.7 * std::sin(2.0 * std::numbers::pi * time / period1 + phase1) +
           0.3 * std::sin(2.0 * std::numbers::pi * time / period2 + phase2);
  }
};

}  // namespace

std::span<const GestureKey> gesture_keys(Gesture gesture) {
  return kGestures.at(static_cast<std::size_t>(gesture)).keys;
}

std::string_view gesture_note(Gesture gesture) {
  return kGestures.at(static_cast<std::size_t>(gesture)).note;
}

Gesture gesture_named(std::string_view name) {
  const auto found = std::find(kGestureNames.begin(), kGestureNames.end(), name);
  if (found == kGestureNames.end()) {
    throw Error(ErrorKind::usage, "there is no gesture \"" + std::string(name) + "\"",
                "use one of: " + joined(kGestureNames));
  }
  return static_cast<Gesture>(found - kGestureNames.begin());
}

ActorPose gesture_pose(Gesture gesture, double frame, std::uint64_t seed) {
  Random random(seed, 0x6765737400ULL + static_cast<std::uint64_t>(gesture));
  const auto keys = gesture_keys(gesture);
  const double time = frame / kGestureFps;
  const double place = std::fmod(frame, static_cast<double>(kGestureFrames));

  ActorPose pose;
  pose.root = {random.uniform(-0.02, 0.02), random.uniform(0.39, 0.41), random.uniform(1.36, 1.42)};
  // Both arms lag during the motion, but not at the pose of rest.
  const std::array<double, 2> lag = {random.uniform(0.0, 2.0), random.uniform(0.0, 2.0)};
  const auto small = [&](double size) { return size * Drift(random).at(time); };
  pose.root += Eigen::Vector3d{small(0.006), small(0.003), small(0.006)};
  pose.sway = small(0.6 * kDegree);
  pose.turn = small(1.5 * kDegree);
  pose.look = small(2.5 * kDegree);
  pose.tilt = small(1.5 * kDegree);
  pose.nod = small(1.0 * kDegree);
  for (std::size_t side = 0; side < 2; ++side) {
    const Numbers n = numbers_at(keys, place - lag[side] * std::sin(std::numbers::pi * place / 164.0), side);
    ActorArm& arm = pose.arms[side];
    arm.upper = Eigen::Vector3d{n[0] + small(0.02), n[1], n[2] + small(0.02)}.normalized();
    arm.fore = Eigen::Vector3d{n[3] + small(0.03), n[4] + small(0.03), n[5]}.normalized();
    arm.pronation = n[6] * kDegree + small(3.0 * kDegree);
    arm.extension = n[7] * kDegree + small(3.0 * kDegree);
    arm.curl = std::clamp(n[8] + small(0.04), 0.0, 1.0);
    pose.lean += 0.5 * n[9] * kDegree;
    pose.nod += 0.5 * n[10] * kDegree;
  }
  return pose;
}

}  // namespace telemime
