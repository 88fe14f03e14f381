// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "telemime/body/limits.h"
#include "telemime/body/motion_frame.h"
#include "telemime/body/shape.h"
#include "telemime/core/camera.h"

namespace telemime {

/// The content of a pose.jsonl, in metres and radians.
struct PoseFile {
  Camera camera;  ///< of the input image
  double fps = 25.0;
  Shape shape;
  JointLimits limits;
  nlohmann::json header;            ///< the whole first line
  std::vector<MotionFrame> frames;  ///< in the order of the file, frame numbers increasing
  std::string complaint;            ///< words about a last line that was cut off; empty when nothing was
};

/// Reads the text of a pose.jsonl. A last line that is cut off (a killed run, a full disk) is left out and
/// reported in `complaint`. Throws Error(input) that names `name`, the line and the key when anything else is
/// wrong: no header, another format or a newer version, a missing joint, a number that is not finite.
/// Required of a frame: frame, time, state, joints; the other keys default when another program left them
/// out.
PoseFile parse_pose_jsonl(std::string_view text, const std::string& name);

/// The same, of a file. Throws Error(input) also when it cannot be read.
PoseFile read_pose_jsonl(const std::filesystem::path& file);

}  // namespace telemime
