// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include "telemime/tracking/heuristics/heuristic.h"

namespace telemime {

/// All heuristics, one line each.
inline constexpr std::size_t kHeuristicCount = 9;
extern const std::array<Heuristic, kHeuristicCount> kHeuristics;

/// "wd, hpm, ...".
std::string heuristic_names();

/// The heuristics of a comma-separated list, in the order in which they run; none is CONDENSATION. Throws
/// Error(usage) for an unknown name, with the choices.
std::vector<const Heuristic*> parse_heuristics(const std::string& names);

}  // namespace telemime
