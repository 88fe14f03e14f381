// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "telemime/outputs/humanoid.h"
#include "telemime/streaming/osc.h"

namespace telemime {

/// The names in which expressions are sent.
enum class VmcExpressions { vrm0, vrm1, arkit };

/// Options in which the receivers of the VMC protocol differ.
struct VmcOptions {
  bool bundles = true;        ///< several messages per datagram; some receivers accept only one
  bool all_positions = true;  ///< false: all bones but the hips are those of an average adult
  bool root_moves = false;    ///< the root moves with the person instead of the hips
  VmcExpressions expressions = VmcExpressions::vrm0;
  std::size_t largest = kLargestDatagram;  ///< bundle, bytes: the protocol requires that it fits in one
};

/// One frame as datagrams of the VMC protocol 3.1, Performer to Marionette: /VMC/Ext/OK (calibrated; tracking
/// or not), /VMC/Ext/T, /VMC/Ext/Root/Pos and a /VMC/Ext/Bone/Pos for each of the 19 bones and, where hands
/// are tracked, of the 30 finger bones, in the left-handed frame of Unity for a VRM 1.0 model: p = (-x, y,
/// z), q = (x, -y, -z, w). `motion` is nullptr while the person is lost: then the first two alone. With a
/// face, /VMC/Ext/Blend/Val for each expression and /VMC/Ext/Blend/Apply follow; without one (nullptr)
/// receivers keep the last. Each bundle begins with /VMC/Ext/OK and /VMC/Ext/T, so that it can be used by
/// itself. `time` in s.
std::vector<std::string> vmc_datagrams(const HumanoidSkeleton& skeleton, const HumanoidMotion* motion,
                                       const FaceMotion* face, double time, const VmcOptions& options);

}  // namespace telemime
