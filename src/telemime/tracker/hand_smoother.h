// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "telemime/body/hand_motion.h"
#include "telemime/tracker/hand_noise.h"
#include "telemime/tracker/one_euro.h"

namespace telemime {

/// How the fingers follow what is measured: by a One-Euro filter, or by a fixed share of the present.
struct HandSmoothing {
  OneEuroOptions one_euro;
  std::optional<double> share;  ///< in (0, 1]
};

/// Steadies both hands. A hand that is not seen goes to rest within about half a second, and its palm to
/// where the body has it.
class HandSmoother {
 public:
  explicit HandSmoother(const HandSmoothing& smoothing) : smoothing_(smoothing) {}

  /// The next frame begins a new motion.
  void restart() { started_ = false; }
  /// `step` seconds after the last frame; `body` is the one at whose wrists the result is placed.
  HandMotions operator()(const HandMotions& measured, const Kinematics& body, double step);

 private:
  struct State {
    std::array<SpeedShare, kFingerCount> finger_speed;
    SpeedShare palm_speed;
    HandNoise noise;
    Eigen::Quaterniond palm = Eigen::Quaterniond::Identity();  ///< camera from hand
    std::optional<Eigen::Quaterniond> last_seen;               ///< palm as measured
  };
  void follow(const HandMotion& measured, const Eigen::Quaterniond& target, double step, State& state,
              HandMotion& smooth) const;

  HandSmoothing smoothing_;
  bool started_ = false;
  HandMotions smooth_;
  std::array<State, 2> state_;
};

}  // namespace telemime
