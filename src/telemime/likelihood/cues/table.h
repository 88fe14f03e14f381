// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "telemime/likelihood/cues/contour.h"
#include "telemime/likelihood/cues/cue.h"
#include "telemime/likelihood/cues/landmarks.h"
#include "telemime/likelihood/cues/region.h"

namespace telemime {

/// The built-in cues, one line each. docs/extending.md says how to add one.
inline constexpr std::array kCues = {
    kRegionCue,
    kContourCue,
    kLandmarkCue,
    kBoneCue,
};

/// Positions in every CueTable of the cues that the tracker also uses by name.
namespace cue {
inline constexpr std::size_t kRegion = 0;
inline constexpr std::size_t kContour = 1;
inline constexpr std::size_t kLandmarks = 2;
inline constexpr std::size_t kBones = 3;
}  // namespace cue
static_assert(kCues[cue::kRegion].name == "regions" && kCues[cue::kContour].name == "contours");

/// One number for each cue, by its position in the table; those behind the last cue are not used.
inline constexpr std::size_t kMostCues = 8;
using CueValues = std::array<double, kMostCues>;
static_assert(kCues.size() <= kMostCues);

/// The cues that a tracker weighs: the built-in ones first, then those that a program adds.
class CueTable {
 public:
  CueTable() : cues_(kCues.begin(), kCues.end()) {}
  /// A table of these cues, which must begin with those of kCues (by name). Throws Error(usage) for other
  /// cues, a name that appears twice, a cue without a cost, or more than kMostCues.
  explicit CueTable(std::span<const Cue> cues);

  /// Adds a cue at the end. Throws as the constructor does.
  void add(const Cue& cue);
  /// Switches one cue on or off; the others keep their positions.
  void enable(std::size_t index, bool enabled) { cues_.at(index).enabled = enabled; }

  std::size_t size() const { return cues_.size(); }
  const Cue& operator[](std::size_t index) const { return cues_[index]; }
  auto begin() const { return cues_.begin(); }
  auto end() const { return cues_.end(); }
  /// What back ends must count for all cues together.
  Reduction needs() const;

 private:
  std::vector<Cue> cues_;
};

/// Cost of `pose` by each cue whose reductions `counted` contains; the other costs are those of Score{}.
/// Computes the kinematics of `input` if a cue needs them.
CueValues cue_costs(const CueTable& cues, CueInput input, const Pose& pose, Reduction counted);

}  // namespace telemime
