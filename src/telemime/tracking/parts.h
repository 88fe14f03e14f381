// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bitset>
#include <cstddef>
#include <string_view>
#include <vector>

#include "telemime/body/pose.h"
#include "telemime/body/skeleton.h"

namespace telemime {

/// Body parts that move nearly independently (thesis 4.4.2.1.2: C, H, LA, RA).
enum class Part : std::size_t { trunk, head, left_arm, right_arm };
inline constexpr std::size_t kPartCount = 4;
inline constexpr std::array<std::string_view, kPartCount> kPartNames = {"trunk", "head", "left_arm",
                                                                        "right_arm"};
using PartSet = std::bitset<kPartCount>;

inline PartSet all_parts() {
  return PartSet().set();
}
inline bool has(const PartSet& parts, Part part) {
  return parts[static_cast<std::size_t>(part)];
}

/// The part to which a number of Pose::vector() belongs.
Part part_of_number(std::size_t index);

/// Indices of Pose::vector() that belong to these parts, in rising order.
std::vector<std::size_t> numbers_of(const PartSet& parts);

/// The part to which a segment belongs.
Part part_of_segment(Segment segment);

}  // namespace telemime
