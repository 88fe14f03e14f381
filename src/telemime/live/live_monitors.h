// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "telemime/live/live_state.h"
#include "telemime/streaming/sender.h"

/// What a live run polls twice a second.
namespace telemime {

/// Timeout of the guided start, which waits for an answer on the page. If no page is open, it first asks the
/// user to open one, and later lets the start continue without. Poll it with update().
class GuideTimeout {
 public:
  enum class Step {
    none,
    ask,   ///< ask the user to open the page; once for each wait
    skip,  ///< no page was opened in time: continue without the guide
  };

  /// `seconds`: time without a page until the guide is skipped, > 0.
  explicit GuideTimeout(double seconds) : seconds_(seconds) {}

  /// `waiting`: the start waits for an answer; `pages`: number of open pages; `now`: s of a monotonic clock.
  Step update(bool waiting, std::size_t pages, double now);

  double seconds() const { return seconds_; }

 private:
  double seconds_;
  std::optional<double> since_;  ///< start of the time without a page
  bool asked_ = false;
};

/// Reports once when an output fails, and once when it sends again. Poll it with update().
class SenderStateReporter {
 public:
  struct Report {
    MessageLevel level = MessageLevel::info;
    std::string text;
  };

  /// The changes since the last call. An output that sends from the start, or that only reconnects, is not
  /// reported.
  std::vector<Report> update(std::span<const SenderStatus> outputs);

 private:
  std::map<std::string, bool> failing_;  // by URL
};

/// The processor time that this process has used, all threads together, s.
double processor_seconds();

/// Cores in use, from occasional readings; the last second counts most.
class CoresInUse {
 public:
  /// `now`: s of any monotonic clock; `used`: processor_seconds() at that time.
  CoresInUse(double now, double used) : time_(now), used_(used) {}
  void read(double now, double used) {
    if (now > time_) {
      value_ = 0.5 * value_ + 0.5 * (used - used_) / (now - time_);
    }
    time_ = now;
    used_ = used;
  }
  double value() const { return value_; }

 private:
  double time_;
  double used_;
  double value_ = 0.0;
};

}  // namespace telemime
