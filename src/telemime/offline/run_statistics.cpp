// SPDX-License-Identifier: Apache-2.0
#include "telemime/offline/run_statistics.h"

#include <algorithm>

namespace telemime {

void RunStatistics::add(const MotionFrame& m) {
  ++frames;
  for (const auto& [stage, ms] : m.stage_ms) {
    stage_ms[stage].push_back(ms);
  }
  if (m.state != TrackState::tracking) {
    return;
  }
  first_tracked = first_tracked < 0 ? m.frame : first_tracked;
  ++tracked;
  region += m.region_score;
  contour += m.contour_score;
  evaluations += m.evaluations;
}

nlohmann::json RunStatistics::json() const {
  const double n = std::max<double>(1.0, static_cast<double>(tracked));
  nlohmann::json json = {
      {"frames", frames},     {"tracked", tracked},      {"first_tracked", first_tracked},
      {"mean_F", region / n}, {"mean_D_C", contour / n}, {"mean_evaluations", evaluations / n}};
  for (const auto& [stage, values] : stage_ms) {
    std::vector<double> sorted = values;
    std::sort(sorted.begin(), sorted.end());
    const auto at = [&](double q) { return sorted[static_cast<std::size_t>(q * (sorted.size() - 1))]; };
    json["ms"][stage] = {{"median", at(0.5)}, {"p95", at(0.95)}};
  }
  return json;
}

}  // namespace telemime
