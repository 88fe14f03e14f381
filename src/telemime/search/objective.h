// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <utility>

#include "telemime/body/limits.h"
#include "telemime/core/settings.h"
#include "telemime/likelihood/backend.h"

namespace telemime {

/// Default weights of the built-in cues, or of those in a table, in one step: `step` is &Cue::region_step or
/// &Cue::edge_step.
constexpr CueValues step_weights(double Cue::*step) {
  CueValues weights{};
  for (std::size_t i = 0; i < kCues.size(); ++i) {
    weights[i] = kCues[i].*step;
  }
  return weights;
}
CueValues step_weights(const CueTable& cues, double Cue::*step);

/// Weights of the terms that a search minimises: the cues' costs (over Cue::scale) and what is known without
/// the image. The table (settings_of) gives the meaning of each.
struct ObjectiveWeights {
  CueValues cues = step_weights(&Cue::region_step);
  double invalid = 4.0;
  double natural = 0.0;
  double temporal = 0.0;
  double trunk = 0.0;
  /// Of the squared depth (in 0.1 m) of elbows and wrists relative to their shoulder: the assumption of the
  /// calibration that the arms are parallel to the image plane (thesis 3.3). Only calibration sets it.
  double fronto_parallel = 0.0;
};

/// The settings of one step of the search; `group` is the first part of their names.
SettingTable settings_of(ObjectiveWeights& weights, const std::string& group);

/// What is known of the arms without the image.
enum class ArmPrior {
  /// Hands before the chest cost less than behind it, low elbows less than high ones (zones of convenient
  /// reach: Panero & Zelnik, Human Dimension and Interior Space, 1979). It presumes a person who faces the
  /// camera.
  reach,
  motion_capture,  ///< how rare the pose of both arms is among people in motion (arm_rarity)
};

/// Landmarks show where the arms are in the picture, so that motion capture may decide how they lie in depth.
/// Colours and outlines alone leave more open.
ArmPrior arm_prior_of(const PreparedFrame& frame);

/// Cost of a pose that people rarely take: 0 at rest, about 1 at the edge of comfort. Neck, wrists and trunk
/// cost least near the middle of their range, the trunk where it is turned to `heading` (rad, torsion of the
/// root).
double natural_cost(const Body& body, const Pose& pose, const Kinematics& kinematics, double heading = 0.0,
                    ArmPrior arms = ArmPrior::reach);

/// Mean over elbows and wrists of the squared distance (in 0.15 m) from their predicted positions. Each joint
/// counts 2 at most, so that an arm that was lost can return.
double distance_from_predicted(const Kinematics& kinematics, const JointPositions& predicted);

/// Pose predicted for the frame after `pose`, which follows `before`: the arms continue with the share
/// `velocity` (0 to 1) of their last motion, inside the limits. The trunk stays, because extrapolating its
/// small motion would only add noise. Shoulder and elbow stay, too, where one of their angles changed by more
/// than 30 rad/s: such an arm was nearly always found elsewhere, not moved. `time_step`: from `before` to
/// `pose`, 1/25 s.
Pose predict_pose(const Pose& pose, const Pose& before, double velocity, double time_step,
                  const JointLimits& limits);

/// The share of the last motion that continues (`velocity`: in frames of equal length), at most 1: after a
/// very short step between two frames their motion is mostly noise. Both steps in 1/25 s.
double share_of_motion(double velocity, double time_step, double time_step_before);

/// Weighted costs of all enabled cues, added to `cost` one after the other.
double add_cue_costs(double cost, const Backend& backend, const PreparedFrame& frame,
                     const CueValues& weights, const Score& score);

/// A pose and what it costs.
struct ScoredPose {
  Pose pose;
  double cost = 0.0;
};

/// What is known about a pose before the image is evaluated.
struct Prior {
  struct Prediction {
    Pose pose;
    JointPositions joints;  ///< m, camera frame
  };
  /// Prediction for this frame; without one the terms "temporal" and "trunk" are 0.
  std::optional<Prediction> predicted = std::nullopt;
  double heading = 0.0;  ///< rad, torsion of the root that natural_cost prefers
};

/// Prior that predicts this pose. `heading` in rad.
Prior prior_at(const Body& body, const Pose& pose, double heading = 0.0);

/// Prior that predicts each joint between its positions in the frames before and after. `share`: of the time
/// between these that has passed, 0 to 1. `heading` in rad.
Prior prior_between(const Body& body, const Pose& before, const Pose& after, double share, double heading);

/// Cost of one pose against one frame. Counts its evaluations. Keeps references to all arguments but the
/// prior: use it within one frame.
class Objective {
 public:
  Objective(Backend& backend, const PreparedFrame& frame, const Model& model, const JointLimits& limits,
            Prior prior = {})
      : backend_(backend), frame_(frame), model_(model), limits_(limits), prior_(std::move(prior)) {}

  /// Cost of the pose. Angles outside the limits add a cost in proportion.
  double operator()(const Pose& pose, const ObjectiveWeights& weights);
  /// Score by the cues whose reductions `terms` contains; counts as one evaluation.
  Score score(const Pose& pose, Reduction terms);

  const Model& model() const { return model_; }
  const JointLimits& limits() const { return limits_; }
  const PreparedFrame& frame() const { return frame_; }
  const CueTable& cues() const { return backend_.cues(); }
  int evaluations() const { return evaluations_; }

 private:
  Score scored(const Pose& pose, Reduction terms, std::span<const Kinematics> kinematics);

  Backend& backend_;
  const PreparedFrame& frame_;
  const Model& model_;
  const JointLimits& limits_;
  Prior prior_;
  int evaluations_ = 0;
};

}  // namespace telemime
