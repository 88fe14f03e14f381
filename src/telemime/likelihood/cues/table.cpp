// SPDX-License-Identifier: Apache-2.0
#include "telemime/likelihood/cues/table.h"

#include <algorithm>
#include <string>

#include "telemime/core/errors.h"
#include "telemime/likelihood/backend.h"

namespace telemime {

CueTable::CueTable(std::span<const Cue> cues) {
  const auto same_name = [](const Cue& a, const Cue& b) { return a.name == b.name; };
  if (cues.size() < kCues.size() || !std::equal(kCues.begin(), kCues.end(), cues.begin(), same_name)) {
    throw Error(ErrorKind::usage, "a table of cues must begin with the built-in ones");
  }
  for (const Cue& cue : cues) {
    add(cue);
  }
}

void CueTable::add(const Cue& cue) {
  const std::string name(cue.name);
  if (cues_.size() == kMostCues) {
    throw Error(ErrorKind::usage, "cue " + name + ": the table is full",
                "A table holds at most " + std::to_string(kMostCues) + " cues.");
  }
  if (std::any_of(begin(), end(), [&](const Cue& other) { return other.name == cue.name; })) {
    throw Error(ErrorKind::usage, "cue " + name + ": the table already has a cue with this name");
  }
  if (cue.name.empty() || cue.cost == nullptr || !(cue.scale > 0.0) || !(cue.sigma > 0.0)) {
    throw Error(ErrorKind::usage,
                "cue " + name + ": a name, a cost, and a scale and a sigma above 0 are needed");
  }
  cues_.push_back(cue);
}

Reduction CueTable::needs() const {
  Reduction all = Reduction::none;
  for (const Cue& cue : cues_) {
    all = all | cue.needs;
  }
  return all;
}

CueValues cue_costs(const CueTable& cues, CueInput input, const Pose& pose, Reduction counted) {
  CueValues costs = Score{}.costs;
  Kinematics kinematics;
  LandmarkPositions landmarks;
  for (std::size_t i = 0; i < cues.size(); ++i) {
    if (!covers(counted, cues[i].needs)) {
      continue;
    }
    const bool compared = cues[i].needs_landmarks && input.frame.landmarks;
    if ((cues[i].needs_kinematics || compared) && input.kinematics == nullptr) {
      kinematics = forward_kinematics(input.model.body, pose);
      input.kinematics = &kinematics;
    }
    if (compared && input.landmarks == nullptr) {
      landmarks = landmark_positions(input.model.body, *input.kinematics);
      input.landmarks = &landmarks;
    }
    costs[i] = cues[i].cost(input);
  }
  return costs;
}

}  // namespace telemime
