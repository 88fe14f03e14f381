// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracker/hand_smoother.h"

#include "telemime/body/arm_parts.h"
#include "telemime/tracker/joint_rotations.h"

namespace telemime {
namespace {

constexpr double kRise = 6.0;     // Hz, of the visibility of a hand that comes into sight
constexpr double kUnseen = 0.02;  // visibility below which a hand is at rest

}  // namespace

void HandSmoother::follow(const HandMotion& measured, const Eigen::Quaterniond& target, double step,
                          State& state, HandMotion& smooth) const {
  const bool seen = measured.visibility > 0.0;
  state.noise.observe(measured, step);
  // A hand that is not seen starts to go to rest slowly.
  const double to_rest = low_pass_share(kHandRestCutoff, step) * state.noise.resting();
  const MeasuredNoise noise{.variance = 3.0 * state.noise.variance(), .ratio = state.noise.ratio()};
  // Fingers, each with its own speed.
  for (std::size_t f = 0; f < kFingerCount; ++f) {
    const double by_speed = state.finger_speed[f](state.noise.change()[f], step, smoothing_.one_euro, noise);
    const double share = !seen ? to_rest : smoothing_.share.value_or(by_speed);
    for (std::size_t a = kFirstFingerAngle[f]; a < kFirstFingerAngle[f + 1]; ++a) {
      smooth.angles[a] += share * (measured.angles[a] - smooth.angles[a]);
    }
  }
  // The palm.
  const Eigen::Quaterniond before = state.last_seen.value_or(target);
  const double by_speed = state.palm_speed(turn_between(before, target), step, smoothing_.one_euro);
  const double share = !seen ? to_rest : smoothing_.share.value_or(by_speed);
  state.palm = state.palm.slerp(share, target).normalized();
  state.last_seen = measured.seen;
  const double rate = measured.visibility > smooth.visibility ? kRise : kHandRestCutoff;
  smooth.visibility += low_pass_share(rate, step) * (measured.visibility - smooth.visibility);
  smooth.visibility = seen || smooth.visibility > kUnseen ? smooth.visibility : 0.0;
  smooth.spread += low_pass_share(rate, step) * (measured.spread - smooth.spread);
}

HandMotions HandSmoother::operator()(const HandMotions& measured, const Kinematics& body, double step) {
  for (std::size_t side = 0; side < 2; ++side) {
    const Eigen::Quaterniond target =
        measured[side].seen.value_or(Eigen::Quaterniond(body[kArmParts[side].hand].linear()));
    if (started_) {
      follow(measured[side], target, step, state_[side], smooth_[side]);
    } else {
      smooth_[side] = measured[side];
      state_[side] = {};
      state_[side].palm = target;
      state_[side].last_seen = measured[side].seen;
      state_[side].noise.observe(measured[side], 0.0);
    }
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
