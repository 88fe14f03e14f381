// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "telemime/core/camera.h"
#include "telemime/likelihood/cues/reductions.h"
#include "telemime/likelihood/prepared_frame.h"

namespace telemime {

/// What a cue can use to compute its cost of one pose.
struct CueInput {
  const PreparedFrame& frame;
  const Model& model;
  const Reductions& reductions;            ///< those of Cue::needs are counted, the others are 0
  const Kinematics* kinematics = nullptr;  ///< of the pose; set if Cue::needs_kinematics is; else unspecified
  /// Landmarks of the pose, m, camera frame; set if Cue::needs_landmarks is and the frame has landmarks; else
  /// unspecified.
  const LandmarkPositions* landmarks = nullptr;
};

/// Unit of a cue's cost.
enum class CueUnit {
  ratio,   ///< independent of the image size
  pixels,  ///< pixels of the working image; scale and sigma are shares of its width
};

/// One source of evidence: how well a pose agrees with a frame. Everything that weighs poses - objectives,
/// the filter's likelihood, the back ends, the ablation - iterates over a CueTable. Lost and found and the
/// backward fill also read F by name.
struct Cue {
  std::string_view name;  ///< unique; names its weights in the configuration
  std::string_view what;  ///< one sentence for help and documentation
  CueUnit unit = CueUnit::ratio;
  Reduction needs = Reduction::none;  ///< what back ends must count for it; often none
  bool needs_kinematics = false;      ///< whether CueInput::kinematics is set
  bool needs_landmarks = false;       ///< whether CueInput::landmarks is set where the frame has landmarks
  double region_step = 0.0;           ///< default weight in the first step of registration
  double edge_step = 1.0;             ///< default weight in the second step, in calibration and recovery
  double scale = 1.0;                 ///< the cost that an objective counts as 1
  double sigma = 1.0;                 ///< standard deviation of the cost in the filter (thesis equation 4.12)
  std::string_view sigma_key = {};    ///< where the filter's model file has a measured sigma; empty: `sigma`
  bool enabled = true;                ///< false: its cost is computed but does not count
  /// How far the cue can be trusted in this frame, from 0 (it knows nothing) to 1; null: always 1. Its cost
  /// counts that much less.
  double (*reliability)(const PreparedFrame& frame) = nullptr;
  /// Cost of the pose: 0 is a perfect match; finite for every frame and pose.
  double (*cost)(const CueInput& input) = nullptr;
};

/// Cue::reliability in this frame; 0 for a cue that is switched off.
inline double reliability_of(const Cue& cue, const PreparedFrame& frame) {
  return !cue.enabled ? 0.0 : cue.reliability != nullptr ? cue.reliability(frame) : 1.0;
}

/// `share` (Cue::scale or a sigma) in the unit of the cue's cost.
inline double in_cost_units(const Cue& cue, double share, const Camera& camera) {
  return cue.unit == CueUnit::pixels ? share * reference_width(camera.width, camera.height) : share;
}

}  // namespace telemime
