// SPDX-License-Identifier: Apache-2.0
#include "telemime/live/live_monitors.h"

#include <sys/resource.h>

#include <algorithm>
#include <utility>

namespace telemime {
namespace {

constexpr double kBrowserStart = 3.0;  // s that a browser may take to open the page

}  // namespace

GuideTimeout::Step GuideTimeout::update(bool waiting, std::size_t pages, double now) {
  if (!waiting || pages > 0) {
    since_.reset();
    asked_ = false;
    return Step::none;
  }
  since_ = since_.value_or(now);
  const double elapsed = now - *since_;
  if (elapsed >= seconds_) {
    since_.reset();
    asked_ = false;
    return Step::skip;
  }
  const bool late = elapsed >= std::min(kBrowserStart, 0.5 * seconds_);
  return late && !std::exchange(asked_, true) ? Step::ask : Step::none;
}

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

double processor_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

}  // namespace telemime
