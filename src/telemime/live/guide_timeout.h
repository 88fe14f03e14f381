// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>

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

}  // namespace telemime
