// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracking/heuristics/all.h"

#include <algorithm>
#include <sstream>

#include "telemime/core/errors.h"
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

const std::array<Heuristic, kHeuristicCount> kHeuristics = {{
    {"modes", "particles of one mode count as one parent", "this program", Stage::merge, Kind::resampling,
     merge_modes},
    {"wd", "weight-based deterministic resampling", "thesis 4.4.2.1", Stage::resample, Kind::resampling,
     resample_by_weight},
    {"hpm", "hierarchical partitioned motion-based sampling", "thesis 4.4.2.2.1", Stage::partition,
     Kind::proposal, find_moving_parts},
    {"ee", "arms in end-effector space: wrist and swivel angle", "thesis 4.4.2.3", Stage::partition,
     Kind::proposal, use_end_effector_space},
    {"lo", "local optimisation of large families", "thesis 4.4.2.2.2", Stage::optimise, Kind::candidates,
     optimise_families},
    {"landmarks", "poses that explain the landmarks of the frame", "thesis 5.2", Stage::optimise,
     Kind::candidates, search_landmarks},
    {"turn", "the trunk turned towards the heading the person may have", "this program", Stage::optimise,
     Kind::candidates, search_heading},
    {"kf", "kinematic flipping of the best particles", "thesis 4.4.2.2.3", Stage::flip_candidates,
     Kind::candidates, flip_best},
    {"arms", "the best left and right arms of all particles on one trunk", "Deutscher & Reid 2005",
     Stage::flip_candidates, Kind::candidates, exchange_best_arms},
}};

std::string heuristic_names() {
  std::string names;
  for (const Heuristic& h : kHeuristics) {
    names.append(names.empty() ? "" : ", ").append(h.name);
  }
  return names;
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
