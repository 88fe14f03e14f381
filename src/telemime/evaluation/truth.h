// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "telemime/body/hand_model.h"
#include "telemime/body/skeleton.h"
#include "telemime/core/camera.h"

namespace telemime {

/// Joints of one frame, m, camera frame; nothing where the truth does not know them.
using TruthJoints = std::array<std::optional<Eigen::Vector3d>, kJointCount>;

/// Where the joints of a clip really are.
struct Truth {
  std::string name;
  Camera camera;  ///< of the image that 2-D errors are measured in
  double fps = 25.0;
  std::vector<TruthJoints> frames;  ///< by frame number
  /// By frame, or empty: the joints of both hands by Side, m, camera frame.
  std::vector<std::array<std::optional<HandPoints>, 2>> hands;
  /// By frame, or empty: camera from head, as FaceMotion::head.
  std::vector<std::optional<Eigen::Quaterniond>> heads;
  std::vector<bool> visible;     ///< by frame: is there a person to track? empty: in every frame
  std::size_t first_scored = 0;  ///< frames outside [first, last] are not scored
  std::size_t last_scored = 0;
  bool scale_known = true;  ///< false: lengths are right up to one unknown factor

  bool is_visible(std::size_t frame) const { return visible.empty() || visible[frame]; }
  bool is_scored(std::size_t frame) const {
    return frame >= first_scored && frame <= last_scored && is_visible(frame);
  }
};

/// Reads the text of a truth.json (docs/evaluation.md). Joints that are unknown to telemime are ignored.
/// Throws Error(input) that names `name`, the place and what is wrong.
Truth parse_truth(std::string_view text, const std::string& name);

/// The same, of a file.
Truth read_truth(const std::filesystem::path& file);

}  // namespace telemime
