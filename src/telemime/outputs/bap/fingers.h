// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "telemime/body/hand_motion.h"
#include "telemime/outputs/bap/profile.h"

namespace telemime {

/// The parameters of the fingers: of each finger of both hands flexion, pivot and twisting of the first joint
/// and flexion of the two others. Those of the bones in the palm (`*0_flexion`) are not tracked.
inline constexpr std::size_t kFingerBapCount = 50;

/// Their ids, ascending; all are above those of the body.
const std::array<int, kFingerBapCount>& finger_bap_ids();

/// Values by place in finger_bap_ids.
using FingerBapValues = std::array<int, kFingerBapCount>;

/// The fingers as the player turns them, `last` as in encode_bap. The rotation of the first joint is the
/// model's; the others bend by the model's angle, for a thumb about the player's own axis.
FingerBapValues encode_bap_fingers(const BapProfile& profile, const HandMotions& hands,
                                   const FingerBapValues& last);

}  // namespace telemime
