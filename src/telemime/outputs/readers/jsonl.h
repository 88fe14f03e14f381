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
  std::string complaint;            ///< a message about a truncated last line; empty if there is none
};

/// Reads the text of a pose.jsonl. A truncated last line (after a killed run or on a full disk) is dropped
/// and reported in `complaint`. Throws Error(input) that names `name`, the line and the key if anything else
/// is wrong: no header, another format or a newer version, a missing joint, a number that is not finite.
/// Required of a frame: frame, time, state, joints; the other keys have defaults, because other programs may
/// not write them.
PoseFile parse_pose_jsonl(std::string_view text, const std::string& name);

/// The same for a file. Also throws Error(input) if it cannot be read.
PoseFile read_pose_jsonl(const std::filesystem::path& file);

}  // namespace telemime
