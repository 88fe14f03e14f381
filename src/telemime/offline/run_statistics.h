// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "telemime/body/motion_frame.h"

namespace telemime {

/// Numbers over the frames of a run, for the report.
struct RunStatistics {
  std::int64_t frames = 0;
  std::int64_t tracked = 0;
  std::int64_t first_tracked = -1;
  double region = 0.0;       ///< sum of F
  double contour = 0.0;      ///< sum of D_C
  double evaluations = 0.0;  ///< sum
  std::map<std::string, std::vector<double>> stage_ms;

  void add(const MotionFrame& m);
  nlohmann::json json() const;
};

}  // namespace telemime
