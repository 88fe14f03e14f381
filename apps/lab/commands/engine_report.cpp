// SPDX-License-Identifier: Apache-2.0
#include "engine_report.h"

#include <algorithm>
#include <iostream>

#include "lab/experiments/engine_agreement.h"
#include "lab/experiments/engine_tables.h"

namespace telemime {

void report_engine(const EngineOptions& options, const std::function<void(const Table&)>& show) {
  const std::vector<std::string> backends = engine_backends(options);
  for (const std::string& line : missing_backends()) {
    std::cout << "not measured, cannot run here: " << line << '\n';
  }
  const std::vector<Throughput> cells = measure_throughput(options);
  show(speed_table(cells));
  show(time_table(cells));
  if (const Table device = device_table(cells); !device.rows.empty()) {
    show(device);
  }
  if (std::find(backends.begin(), backends.end(), "simd") != backends.end()) {
    show(stage_table(options));
    show(instruction_set_table(options));
    show(opencv_table(options));
  }
  show(overlap_time_table(options));
  if (backends.size() > 1 || backends.front() != "scalar") {
    show(agreement_table(options));
    show(ranking_table(options));
  }
  std::cout << "time on the wall, best of several; '-': would take too long\n";
}

}  // namespace telemime
