// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "telemime/core/random.h"
#include "telemime/core/settings.h"
#include "telemime/search/arm_search.h"
#include "telemime/search/shape_refine.h"
#include "telemime/search/two_step.h"

namespace telemime {

/// Settings of the calibration; the table (settings_of) gives the meaning, unit and range of each.
struct CalibrationConfig {
  std::optional<double> stature;  ///< m; none: an average head sets the scale
  double nearest = 0.35;
  double farthest = 5.0;
  ArmSearchConfig arms;
  ShapeFitConfig shape;
  ShapeRefineConfig refine;
  int look_ahead = 150;
  int rounds = 2;
  int pose_iterations = 800;
  double fronto_parallel = 0.03;
  double worst_region = 0.45;
};

SettingTable settings_of(CalibrationConfig& config);

struct Calibration {
  Shape shape;
  Pose pose;
  Score score;
  int evaluations = 0;
  /// Why the arms could not be fitted in this frame, for messages; empty: they were.
  std::string refusal;
};

/// Places an average body at the head in the image: distance from the head's height, trunk upright and turned
/// to the camera, arms hanging (thesis 3.3, "model translation").
Pose place_at_head(const Body& body, const HeadRegion& head, const Camera& camera);

/// Pose of a person of known shape without an earlier frame: from the landmarks where the frame has them,
/// else from the position of the head alone: the depth that minimises F, then a global search of each arm,
/// then registration of the whole pose.
Pose initialise_pose(Objective& objective, const HeadRegion& head, const CalibrationConfig& config,
                     const RegistrationConfig& registration, Random& random);

/// The three steps of thesis 3.3 on one frame: translation, pose, shape. When an arm covers the body or
/// leaves the image, the result says so in `refusal`.
Calibration calibrate(Backend& backend, const PreparedFrame& frame, const HeadRegion& head,
                      const JointLimits& limits, const CalibrationConfig& config,
                      const RegistrationConfig& registration, Random& random);

}  // namespace telemime
