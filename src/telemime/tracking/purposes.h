// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

/// Streams of random numbers of one frame (FilterContext::random): each purpose has its own, so that a
/// heuristic that is switched off changes no other's draws.
namespace telemime::purpose {

inline constexpr std::uint64_t kResampling = 1;
inline constexpr std::uint64_t kDiffusion = 2;
inline constexpr std::uint64_t kSimplex = 3;
inline constexpr std::uint64_t kHeadingSearch = 4;

}  // namespace telemime::purpose
