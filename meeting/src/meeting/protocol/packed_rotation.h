// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>

namespace telemime::meeting {

/// Number of bits of a packed rotation. The highest bit of its six bytes is 0.
inline constexpr int kPackedRotationBits = 47;

/// Packs a rotation into 47 bits by the "smallest three" method: the three components other than the largest,
/// in the order x y z w, with 15 bits each (from bits 0, 15 and 30), then the index of the largest (bits 45
/// and 46; 0 x to 3 w; the first if several are equal). A component v in [-1/sqrt2, 1/sqrt2] becomes floor((v
/// sqrt2 + 1) / 2 * 32767 + 1/2). A quaternion and its negative give the same bits. The error is below 0.01
/// degrees. `rotation` must be finite and of non-zero length.
std::uint64_t pack_rotation(const Eigen::Quaterniond& rotation);

/// Unpacks a rotation, a quaternion of length 1; bits above kPackedRotationBits are ignored. Returns nothing
/// when the squares of the three components sum to more than 1.001.
std::optional<Eigen::Quaterniond> unpack_rotation(std::uint64_t bits);

}  // namespace telemime::meeting
