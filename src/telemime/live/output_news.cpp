// SPDX-License-Identifier: Apache-2.0
#include "telemime/live/output_news.h"

#include <utility>

namespace telemime {

std::vector<OutputNews::Words> OutputNews::look(std::span<const SenderStatus> outputs) {
  std::vector<Words> news;
  std::map<std::string, bool> now;  // without those that were removed
  for (const SenderStatus& output : outputs) {
    const auto before = fails_.find(output.url);
    const bool failed = before != fails_.end() && before->second;
    bool& fails = now[output.url] = failed;
    if (output.state == SenderState::failed && !failed) {
      fails = true;
      news.push_back({MessageLevel::warning, output.url + ": " + output.words});
    } else if (output.state == SenderState::sending && failed) {
      fails = false;
      news.push_back({MessageLevel::info, output.url + ": sending now"});
    } else if (output.state == SenderState::off) {
      fails = false;
    }
  }
  fails_ = std::move(now);
  return news;
}

}  // namespace telemime
