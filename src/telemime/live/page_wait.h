// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>

namespace telemime {

/// The guided start waits for somebody who answers on the page. Who started the program for its outputs alone
/// opens none: decides when to ask for a page, and when to go on without.
class PageWait {
 public:
  enum class Step {
    none,
    ask,    ///< say that a page is waited for; once in each wait
    go_on,  ///< nobody came
  };

  /// `patience`: s without a page until the start goes on without, > 0.
  explicit PageWait(double patience) : patience_(patience) {}

  /// To be called now and then. `asks`: the start waits for an answer; `pages` are open; `now` in s of a
  /// clock that never goes back.
  Step look(bool asks, std::size_t pages, double now);

  double patience() const { return patience_; }

 private:
  double patience_;
  std::optional<double> since_;  ///< without a page
  bool asked_ = false;
};

}  // namespace telemime
