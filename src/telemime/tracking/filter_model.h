// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <string>

#include "telemime/body/pose.h"
#include "telemime/likelihood/cues/table.h"
#include "telemime/tracking/parts.h"

namespace telemime {

/// Standard deviations of the true joints about a pose that fits the image.
struct SpreadModel {
  double trunk = 0.0;  ///< m, each joint of the trunk
  /// Neck, head, crown and root, as a share of their distance from the middle of the shoulders: uncertainty
  /// of the trunk's and the head's lean.
  double lean = 0.0;
  double across = 0.0;  ///< end of a bone across the viewing ray, as a share of its length
  /// Uncertainty of a bone's visible length, as a share of it: the depth of a bone at the angle phi to the
  /// image plane is known to about seen / sin(phi) of its length, that of a bone parallel to the image to
  /// sqrt(seen / 2).
  double seen = 0.0;
  double slide = 0.0;  ///< m, wrist along its forearm: bare skin does not show where the hand begins
  /// F of the poses from which these numbers were estimated. The standard deviations of a pose that fits
  /// worse grow with the square of its F over this one, where landmarks hold the pose with its square root.
  double residual = 0.0;
  double size = 0.0;        ///< size of the person, as a share of it, estimated from an average head
  double size_given = 0.0;  ///< the same with a given height
};

/// Numbers that the filter takes from sequences (data/filter.json, written by `telemime-lab learn`): how much
/// the scores vary and how people move from one frame to the next at 25 frames a second.
struct FilterModel {
  CueValues sigma{};  ///< of each cue's cost (thesis equation 4.12): sigma_F, sigma_D; see Cue::sigma
  /// Cost of each cue, a share like sigma, in the clips in which sigma was measured. In a frame with
  /// landmarks a larger cost counts by its logarithm: the image is noisier by an unknown factor. 0: sigma
  /// holds in every image. The regions have SpreadModel::residual, the others 0.
  CueValues usual{};
  PoseVector change = PoseVector::Zero();  ///< standard deviations of equation 4.13: m, rad
  /// alpha_k of equation 4.20: a part moves when it uncovers at least this share of its pixels.
  std::array<double, kPartCount> motion{};
  double wrist_across = 0.0;  ///< standard deviations in end-effector space: m across the viewing ray
  double wrist_along = 0.0;   ///< m along it
  double swivel = 0.0;        ///< rad
  SpreadModel spread;
};

/// Reads the JSON text; each cue without a sigma_key has its own sigma. `name` is for messages. Throws
/// Error(config) that names what is missing or wrong.
FilterModel parse_filter_model(const std::string& json, const std::string& name, const CueTable& cues = {});

/// The numbers of a file; an empty name stands for data/filter.json. Throws Error(config).
FilterModel load_filter_model(const std::string& file, const CueTable& cues = {});

/// JSON text that parse_filter_model reads.
std::string to_json_text(const FilterModel& model, const std::string& note);

}  // namespace telemime
