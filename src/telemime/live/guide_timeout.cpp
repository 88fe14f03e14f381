// SPDX-License-Identifier: Apache-2.0
#include "telemime/live/guide_timeout.h"

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

}  // namespace telemime
