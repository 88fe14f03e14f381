// SPDX-License-Identifier: Apache-2.0
#include "telemime/live/sender_state_reporter.h"

#include <utility>

namespace telemime {

std::vector<SenderStateReporter::Report> SenderStateReporter::update(std::span<const SenderStatus> outputs) {
  std::vector<Report> reports;
  std::map<std::string, bool> next;  // contains the listed outputs only
  for (const SenderStatus& output : outputs) {
    const auto previous = failing_.find(output.url);
    const bool was_failing = previous != failing_.end() && previous->second;
    bool& failing = next[output.url] = was_failing;
    if (output.state == SenderState::failed && !was_failing) {
      failing = true;
      reports.push_back({MessageLevel::warning, output.url + ": " + output.words});
    } else if (output.state == SenderState::sending && was_failing) {
      failing = false;
      reports.push_back({MessageLevel::info, output.url + ": sending again"});
    } else if (output.state == SenderState::off) {
      failing = false;
    }
  }
  failing_ = std::move(next);
  return reports;
}

}  // namespace telemime
