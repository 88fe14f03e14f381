// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "meeting/protocol/pose_frame.h"
#include "telemime/body/motion_frame.h"
#include "telemime/outputs/humanoid.h"

namespace telemime::meeting {

/// The bones that this project's tracker knows: hips to hands. Legs are left out, they stand still.
inline constexpr std::uint32_t kTrackedBones = (1U << static_cast<unsigned>(HumanBone::l_upper_leg)) - 1U;

/// A standard deviation (m, >= 0) as the confidence of a bone: 15 up to 20 mm, 1 from 200 mm on, in between
/// evenly.
std::uint8_t confidence_of(double deviation);

/// The tracked person's frame, without session, sequence and time. The confidence of a bone is that of the
/// joint that it moves (spine and chest: neck; lower arm: wrist; hand: middle knuckle; hips: root), whose
/// standard deviation is the root of the mean of the three axes' variances; 0 for all when there is no
/// spread. Hips are held within the 32 m that the frame can say.
PoseFrame pose_frame_of(const HumanoidMotion& motion, const std::optional<PoseSpread>& spread);

}  // namespace telemime::meeting
