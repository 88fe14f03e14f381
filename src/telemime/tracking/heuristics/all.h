// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include "telemime/tracking/heuristics/heuristic.h"

namespace telemime {

/// Every heuristic, one line each.
inline constexpr std::size_t kHeuristicCount = 7;
extern const std::array<Heuristic, kHeuristicCount> kHeuristics;

/// "wd, hpm, ...".
std::string heuristic_names();

/// The heuristics of a list with commas, in the order in which they run. Throws Error(usage) for an unknown
/// name, with the choices; an empty list is CONDENSATION.
std::vector<const Heuristic*> parse_heuristics(const std::string& names);

}  // namespace telemime
