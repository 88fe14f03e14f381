// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "telemime/body/limits.h"
#include "telemime/likelihood/backend.h"

namespace telemime {

/// What a search minimises: the cues' costs plus what is known without looking at the image.
struct ObjectiveWeights {
  double region = 1.0;   ///< of F
  double contour = 0.0;  ///< of D_C over contour_scale
  double contour_scale =
      0.02;              ///< D_C is divided by this share of the image's width, so that it is of F's size
  double invalid = 4.0;  ///< per metre of interpenetration
  double natural = 0.0;  ///< of natural_cost
  /// Of the squared way (m over 0.15 m) of elbows and wrists from where they are expected.
  double temporal = 0.0;
  /// Of the squared change of the trunk (m over 0.03 m, rad over 0.1) from what is expected.
  double trunk = 0.0;
  /// Of the squared depth (m over 0.1 m) of elbows and wrists before or behind their shoulder: calibration
  /// assumes that the person holds the arms parallel to the image (thesis 3.3).
  double fronto_parallel = 0.0;
};

/// A mild preference for poses that people take: hands before the chest rather than behind it, elbows low,
/// neck, wrists and trunk near their middle; the trunk turned to where `facing` (rad, as the root's torsion)
/// says. 0 at rest; about 1 for a pose at the edge of comfort. Ranges: Panero & Zelnik, Human Dimension and
/// Interior Space, 1979 (zones of convenient reach).
double natural_cost(const Body& body, const Pose& pose, const Kinematics& kinematics, double facing = 0.0);

/// Mean over elbows and wrists of the squared way (over 0.15 m) from where they are expected, each counted as
/// 2 at most: an arm that was lost must be able to come back.
double distance_from_expected(const Kinematics& kinematics, const JointPositions& expected);

/// The pose that is expected in the next frame after `before` and `pose`: the arms go on by the share
/// `velocity` (0 to 1) of their last motion, inside the limits. The trunk hardly moves, and to carry it on
/// would only shake it.
Pose expected_pose(const Pose& pose, const Pose& before, double velocity, const JointLimits& limits);

/// Cost of one pose against one frame. Counts its evaluations. Holds references: use it within one frame.
class Objective {
 public:
  Objective(Backend& backend, const PreparedFrame& frame, const Model& model, const JointLimits& limits)
      : backend_(backend), frame_(frame), model_(model), limits_(limits) {}

  /// Cost of the pose. Angles outside the limits cost extra in proportion.
  double operator()(const Pose& pose, const ObjectiveWeights& weights);
  /// F and D_C of the pose; counts as one evaluation.
  Score score(const Pose& pose, Reduction terms);
  /// The pose that is expected in this frame, for the terms "temporal" and "trunk"; without it they are 0.
  void expect(const Pose& pose) { expected_ = Expected{pose, forward_kinematics(model_.body, pose).joints}; }
  /// The same from the frames before and after: every joint in the middle between its places there.
  void expect_between(const Pose& before, const Pose& after);

  /// Where the person is expected to face, for the term "natural": torsion of the root, rad.
  void face(double facing) { facing_ = facing; }

  const Model& model() const { return model_; }
  const JointLimits& limits() const { return limits_; }
  const PreparedFrame& frame() const { return frame_; }
  int evaluations() const { return evaluations_; }

 private:
  Backend& backend_;
  const PreparedFrame& frame_;
  const Model& model_;
  const JointLimits& limits_;
  struct Expected {
    Pose pose;
    JointPositions joints;
  };
  std::optional<Expected> expected_;
  double facing_ = 0.0;
  int evaluations_ = 0;
};

}  // namespace telemime
