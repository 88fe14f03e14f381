// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>

namespace telemime::meeting {

/// Bits of a packed rotation; one more, the highest of its six bytes, is 0.
inline constexpr int kPackedRotationBits = 47;

/// A rotation in 47 bits, "smallest three": the three components other than the largest, in the order x y z
/// w, 15 bits each (bits 0, 15, 30 and up), then which one was the largest (bits 45 and 46; 0 x to 3 w; the
/// first of those that are as large). A component v, in [-1/sqrt2, 1/sqrt2], is floor((v sqrt2 + 1) / 2 *
/// 32767 + 1/2). A quaternion and its negative give the same bits. The rotation that comes back is less than
/// 0.01 degrees away. `rotation`: finite, of any length but 0.
std::uint64_t pack_rotation(const Eigen::Quaterniond& rotation);

/// The rotation of these bits, of length 1; bits above kPackedRotationBits do not count. Nothing when the sum
/// of the three components' squares is more than 1.001: that is no rotation.
std::optional<Eigen::Quaterniond> unpack_rotation(std::uint64_t bits);

}  // namespace telemime::meeting
