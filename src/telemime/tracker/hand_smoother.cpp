// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracker/hand_smoother.h"

#include <algorithm>
#include <array>
#include <numbers>

#include "telemime/tracker/joint_rotations.h"

namespace telemime {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
// How much two looks at the same synthetic hands differ in an angle: of a clear hand, and of one of which
// nothing is known, as of a middle joint anywhere between 0 and 110 degrees. docs/hands.md has what was
// measured.
constexpr double kClear = 2.2 * kDegree;
constexpr double kUnknown = 32.0 * kDegree;
constexpr double kNoiseCutoff = 0.6;  // Hz, of the noise of a hand that becomes clear
constexpr double kRestCutoff = 1.0;   // Hz: 85 % of the way to rest in half a second
constexpr double kRise = 6.0;         // Hz, of the visibility of a hand that comes into sight
constexpr double kUnseen = 0.02;      // visibility below which a hand is at rest

// Variance of an angle.
double variance_of(double visibility) {
  const double unknown = (1.0 - visibility) * kUnknown;
  return kClear * kClear + unknown * unknown;
}

}  // namespace

void HandSmoother::follow(const HandMotion& measured, const Eigen::Quaterniond& target, double step,
                          State& state, HandMotion& smooth) const {
  const bool seen = measured.visibility > 0.0;
  // Where a hand comes into sight, the way from its form at rest is not a motion.
  const bool appears = seen && !(state.last.visibility > 0.0);
  // A hand that is not seen starts to go to rest slowly.
  const double to_rest = low_pass_share(kRestCutoff, step);
  state.resting = seen ? 0.0 : state.resting + to_rest * (1.0 - state.resting);
  // What changed. White noise makes changes that follow each other opposite: minus their product is its
  // variance.
  std::array<Eigen::Vector3d, kFingerCount> change;
  double white = 0.0;
  for (std::size_t f = 0; f < kFingerCount; ++f) {
    for (std::size_t a = 0; a < 3; ++a) {
      const std::size_t angle = kFirstFingerAngle[f] + a;
      change[f][static_cast<Eigen::Index>(a)] =
          appears ? 0.0 : measured.angles[angle] - state.last.angles[angle];
    }
    white -= change[f].dot(state.change[f]) / (3.0 * kFingerCount);
  }
  state.change = change;
  // How far the angles are wrong: as the visibility says, at once where it is bad and for a while after that,
  // or as the jitter says.
  if (seen) {
    const double learned = low_pass_share(kNoiseCutoff, step);
    const double now = variance_of(measured.visibility);
    state.variance = std::max(now, state.variance + learned * (now - state.variance));
    state.jitter += learned * (white - state.jitter);
  }
  const double variance = std::max({kClear * kClear, state.variance, state.jitter});
  const MeasuredNoise noise{.variance = 3.0 * variance, .ratio = variance / (kClear * kClear)};
  // Fingers, each with its own speed.
  for (std::size_t f = 0; f < kFingerCount; ++f) {
    const double by_speed = state.finger_speed[f](change[f], step, smoothing_.one_euro, noise);
    const double share = !seen ? to_rest * state.resting : smoothing_.share.value_or(by_speed);
    for (std::size_t a = kFirstFingerAngle[f]; a < kFirstFingerAngle[f + 1]; ++a) {
      smooth.angles[a] += share * (measured.angles[a] - smooth.angles[a]);
    }
  }
  // The palm.
  const Eigen::Quaterniond before = state.last.seen.value_or(target);
  const double by_speed = state.palm_speed(turn_between(before, target), step, smoothing_.one_euro);
  const double share = !seen ? to_rest * state.resting : smoothing_.share.value_or(by_speed);
  state.palm = state.palm.slerp(share, target).normalized();
  const double rate = measured.visibility > smooth.visibility ? kRise : kRestCutoff;
  smooth.visibility += low_pass_share(rate, step) * (measured.visibility - smooth.visibility);
  smooth.visibility = seen || smooth.visibility > kUnseen ? smooth.visibility : 0.0;
  smooth.spread += low_pass_share(rate, step) * (measured.spread - smooth.spread);
}

HandMotions HandSmoother::operator()(const HandMotions& measured, const Kinematics& body, double step) {
  for (std::size_t side = 0; side < 2; ++side) {
    const Segment segment = side == 0 ? Segment::l_hand : Segment::r_hand;
    const Eigen::Quaterniond target =
        measured[side].seen.value_or(Eigen::Quaterniond(body[segment].linear()));
    if (started_) {
      follow(measured[side], target, step, state_[side], smooth_[side]);
    } else {
      smooth_[side] = measured[side];
      state_[side] = {};
      state_[side].palm = target;
    }
    state_[side].last = measured[side];
    smooth_[side].sizes = measured[side].sizes;
    smooth_[side].seen.reset();
    if (smooth_[side].visibility > 0.0) {
      smooth_[side].seen = state_[side].palm;
    }
  }
  started_ = true;
  HandMotions result = smooth_;
  place_hands(body, result);
  return result;
}

}  // namespace telemime
