// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "telemime/body/hand_motion.h"
#include "telemime/core/camera.h"
#include "telemime/image/frame_features.h"

namespace telemime {

/// What is known of a person's hands from the frames before: plain data.
struct HandState {
  std::optional<HandSizes> sizes;  ///< learned; empty: no hand was seen yet
  double frames = 0.0;             ///< that it was learned from
  struct Last {
    HandMotion motion;
    double time = 0.0;  ///< when it was seen, s
  };
  std::array<std::optional<Last>, 2> last;  ///< by Side
};

/// What `observe_hands` knows of a frame. `camera` is that of the pixels of the findings.
struct HandScene {
  const Body& body;
  const Kinematics& kinematics;
  const Camera& camera;
  double time = 0.0;  ///< s
};

/// Which finding is whose hand, by Side: that of the arm whose wrist is nearest, neither twice nor farther
/// from it than a wrist's error. Empty: none. They point into `seen`, which must outlive them.
std::array<const HandLandmarks*, 2> hands_of_arms(const std::array<SeenHand, 2>& seen,
                                                  const HandScene& scene);
std::array<const HandLandmarks*, 2> hands_of_arms(std::array<SeenHand, 2>&& seen,
                                                  const HandScene& scene) = delete;

/// The points of a finding in m from its wrist, camera frame, for a wrist at `depth` m: its place in the
/// picture with the depths that the network gives.
HandPoints metric_points(const HandLandmarks& hand, const Camera& camera, double depth);

/// The hands of one frame, not smoothed: fitted to the findings; one that is not seen keeps its last form for
/// a tenth of a second and is then at rest. The sizes of the person's hands are learned on the way.
HandMotions observe_hands(const std::array<SeenHand, 2>& seen, const HandScene& scene, HandState& state);

}  // namespace telemime
