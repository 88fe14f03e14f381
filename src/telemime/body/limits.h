// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <string>

#include "telemime/body/pose.h"

namespace telemime {

/// Range of each joint angle, rad; min <= max.
struct JointLimits {
  std::string name;
  std::array<double, kAngleCount> min{};
  std::array<double, kAngleCount> max{};

  bool contains(const Pose& pose, double tolerance = 1e-9) const;
  /// The nearest pose inside the limits; the translation does not change.
  Pose clamp(const Pose& pose) const;
};

/// Table 2-1 of the thesis: a seated speaker's gestures, no hands above the head.
JointLimits reference_limits();

/// Ranges of motion of healthy adults (American Academy of Orthopaedic Surgeons, 1965; arm elevation and
/// axial rotation as in Boone & Azen, J. Bone Joint Surg. 61-A, 1979). The default.
JointLimits anatomical_limits();

/// "reference", "anatomical" or a JSON file {"name": ..., "limits": {"l_elbow_flexion": [min, max], ...}}
/// in degrees, all 20 angles. Throws Error(config) that names what is wrong.
JointLimits load_limits(const std::string& name_or_file);

}  // namespace telemime
