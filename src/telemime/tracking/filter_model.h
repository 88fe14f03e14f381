// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <string>

#include "telemime/body/pose.h"
#include "telemime/tracking/parts.h"

namespace telemime {

/// How far the truth is from a pose that fits the image (standard deviations).
struct SpreadModel {
  double trunk = 0.0;  ///< m, of each joint of the trunk
  /// Of neck, head, crown and root, as a share of their way from the middle of the shoulders: how well the
  /// trunk's and the head's lean are known.
  double lean = 0.0;
  double across = 0.0;  ///< of a bone's end across the viewing ray, as a share of its length
  /// The part of its length to which a bone is seen: at the angle phi to the image plane it is known in depth
  /// to about seen / sin(phi) of its length, parallel to the image to sqrt(seen / 2).
  double seen = 0.0;
  double slide = 0.0;  ///< m, of a wrist along its forearm: bare skin does not show where the hand begins
  /// F of the poses that these numbers are of. A pose that fits worse is known worse, in proportion to the
  /// square of its F over this.
  double residual = 0.0;
  double size = 0.0;        ///< of the person's size, as a share of it, from an average head
  double size_given = 0.0;  ///< the same with a height that was given
};

/// What the filter knows from sequences (data/filter.json, made by `telemime-lab learn`): how much the scores
/// vary and how people move from one frame to the next at 25 frames a second.
struct FilterModel {
  double sigma_region = 0.0;               ///< sigma_F of thesis equation 4.12
  double sigma_contour = 0.0;              ///< sigma_D, as a share of the image's width
  PoseVector change = PoseVector::Zero();  ///< standard deviations of equation 4.13: m, rad
  /// alpha_k of equation 4.20: a part moves when it uncovers this share of its pixels.
  std::array<double, kPartCount> motion{};
  double wrist_across = 0.0;  ///< standard deviations in end-effector space: m across the viewing ray
  double wrist_along = 0.0;   ///< m along it
  double swivel = 0.0;        ///< rad
  SpreadModel spread;
};

/// The numbers of data/filter.json.
FilterModel default_filter_model();

/// Throws Error(config) that names what is missing or wrong; `name` is for messages.
FilterModel parse_filter_model(const std::string& json, const std::string& name);

/// The built-in numbers for an empty name, else those of the file. Throws Error(config).
FilterModel load_filter_model(const std::string& file);

/// As parse_filter_model reads it.
std::string to_json_text(const FilterModel& model, const std::string& note);

}  // namespace telemime
