// SPDX-License-Identifier: Apache-2.0
#include "lab/synth/gesture.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "telemime/core/errors.h"
#include "telemime/core/random.h"

namespace telemime {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr std::size_t kNumbers = 11;  // of one arm (9), lean, nod
using Numbers = std::array<double, kNumbers>;

Numbers numbers_of(const GestureKey& key, std::size_t side) {
  const GestureArmKey& a = side == 0 ? key.left : key.right;
  return {a.upper[0],  a.upper[1],  a.upper[2], a.fore[0], a.fore[1], a.fore[2],
          a.pronation, a.extension, a.curl,     key.lean,  key.nod};
}

// Slope of the monotone cubic at a key: the weighted harmonic mean of the slopes beside it, 0 at a turn.
double slope_at(double before, double after, double step_before, double step_after) {
  if (before * after <= 0.0) {
    return 0.0;
  }
  const double w1 = 2.0 * step_after + step_before;
  const double w2 = step_after + 2.0 * step_before;
  return (w1 + w2) / (w1 / before + w2 / after);
}

Numbers numbers_at(std::span<const GestureKey> keys, double frame, std::size_t side) {
  frame = std::clamp(frame, keys.front().frame, keys.back().frame);
  std::size_t i = 0;
  while (i + 2 < keys.size() && frame >= keys[i + 1].frame) {
    ++i;
  }
  const double step = keys[i + 1].frame - keys[i].frame;
  const double t = (frame - keys[i].frame) / step;
  const Numbers a = numbers_of(keys[i], side);
  const Numbers b = numbers_of(keys[i + 1], side);
  // A key doubled at either end rests there.
  const GestureKey& first = keys[i == 0 ? 0 : i - 1];
  const GestureKey& last = keys[std::min(i + 2, keys.size() - 1)];
  const Numbers p = numbers_of(first, side);
  const Numbers n = numbers_of(last, side);
  Numbers result{};
  for (std::size_t k = 0; k < kNumbers; ++k) {
    const double rise = (b[k] - a[k]) / step;
    const double step_before = keys[i].frame - first.frame;
    const double step_after = last.frame - keys[i + 1].frame;
    const double m0 = step_before > 0 ? slope_at((a[k] - p[k]) / step_before, rise, step_before, step) : 0.0;
    const double m1 = step_after > 0 ? slope_at(rise, (n[k] - b[k]) / step_after, step, step_after) : 0.0;
    const double t2 = t * t;
    const double t3 = t2 * t;
    result[k] = (2 * t3 - 3 * t2 + 1) * a[k] + (t3 - 2 * t2 + t) * step * m0 + (3 * t2 - 2 * t3) * b[k] +
                (t3 - t2) * step * m1;
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

Gesture gesture_named(std::string_view name) {
  const auto found = std::find(kGestureNames.begin(), kGestureNames.end(), name);
  if (found == kGestureNames.end()) {
    std::string names;
    for (const auto& known : kGestureNames) {
      names += (names.empty() ? "" : ", ") + std::string(known);
    }
    throw Error(ErrorKind::usage, "there is no gesture \"" + std::string(name) + "\"",
                "use one of: " + names);
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
