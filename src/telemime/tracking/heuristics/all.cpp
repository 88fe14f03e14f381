// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracking/heuristics/all.h"

#include <algorithm>
#include <sstream>

#include "telemime/core/errors.h"
#include "telemime/core/text.h"
#include "telemime/tracking/heuristics/arm_exchange.h"
#include "telemime/tracking/heuristics/end_effector.h"
#include "telemime/tracking/heuristics/heading_search.h"
#include "telemime/tracking/heuristics/kinematic_flipping.h"
#include "telemime/tracking/heuristics/landmark_search.h"
#include "telemime/tracking/heuristics/local_optimisation.h"
#include "telemime/tracking/heuristics/modes.h"
#include "telemime/tracking/heuristics/motion_partition.h"
#include "telemime/tracking/heuristics/weight_resampling.h"

namespace telemime {

// In parentheses: the section of the thesis.
const std::array<Heuristic, kHeuristicCount> kHeuristics = {{
    {"modes", Stage::merge, merge_modes},              // particles of one mode count as one parent
    {"wd", Stage::resample, resample_by_weight},       // weight-based deterministic resampling (4.4.2.1)
    {"hpm", Stage::partition, find_moving_parts},      // hierarchical partitions by motion (4.4.2.2.1)
    {"ee", Stage::partition, use_end_effector_space},  // arms by wrist and swivel angle (4.4.2.3)
    {"lo", Stage::optimise, optimise_families},        // local optimisation of large families (4.4.2.2.2)
    {"landmarks", Stage::optimise, search_landmarks},  // poses that explain the landmarks (5.2)
    {"turn", Stage::optimise, search_heading},         // the trunk turned to the heading that it may have
    {"kf", Stage::flip_candidates, flip_best},         // kinematic flipping of the best particles (4.4.2.2.3)
    {"arms", Stage::flip_candidates, exchange_best_arms},  // Deutscher & Reid 2005: best arms on one trunk
}};

std::string heuristic_names() {
  return joined(kHeuristics, &Heuristic::name);
}

std::vector<const Heuristic*> parse_heuristics(const std::string& names) {
  std::vector<bool> wanted(kHeuristics.size());
  std::istringstream list(names);
  for (std::string name; std::getline(list, name, ',');) {
    const auto first = name.find_first_not_of(' ');
    name = first == std::string::npos ? "" : name.substr(first, name.find_last_not_of(' ') - first + 1);
    const auto found = std::find_if(kHeuristics.begin(), kHeuristics.end(),
                                    [&](const Heuristic& h) { return h.name == name; });
    if (found == kHeuristics.end()) {
      throw Error(
          ErrorKind::usage, "unknown heuristic '" + name + "'",
          "Choose from " + heuristic_names() + ", separated by commas; an empty list is CONDENSATION.");
    }
    wanted[static_cast<std::size_t>(found - kHeuristics.begin())] = true;
  }
  std::vector<const Heuristic*> heuristics;
  for (std::size_t i = 0; i < kHeuristics.size(); ++i) {
    if (wanted[i]) {
      heuristics.push_back(&kHeuristics[i]);
    }
  }
  std::stable_sort(heuristics.begin(), heuristics.end(),
                   [](const Heuristic* a, const Heuristic* b) { return a->stage < b->stage; });
  return heuristics;
}

}  // namespace telemime
