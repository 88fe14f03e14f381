// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "avatars/figure.h"

namespace telemime {

/// Which bones a point of the skin follows: up to four, the weights sum to 1.
struct SkinWeights {
  std::array<std::uint8_t, 4> bone{};  ///< HumanBone, or finger_node()
  std::array<double, 4> weight{};
};

/// For a point of the T-pose (m): one smooth function of space, so that layers of clothes move with what is
/// under them.
SkinWeights skin_weights(const Figure& figure, const Eigen::Vector3d& point);

/// All bones that a point can follow.
inline constexpr std::size_t kSkinBoneCount = kHumanBoneCount + kFingerBoneCount;

/// All of it follows one bone.
SkinWeights rigid(HumanBone bone);

}  // namespace telemime
