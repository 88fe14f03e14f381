// SPDX-License-Identifier: Apache-2.0
#include "telemime/live/page_wait.h"

#include <algorithm>
#include <utility>

namespace telemime {
namespace {

constexpr double kSlowBrowser = 3.0;  // s, that a page may take that is being opened

}  // namespace

PageWait::Step PageWait::look(bool asks, std::size_t pages, double now) {
  if (!asks || pages > 0) {
    since_.reset();
    asked_ = false;
    return Step::none;
  }
  since_ = since_.value_or(now);
  const double alone = now - *since_;
  if (alone >= patience_) {
    since_.reset();
    asked_ = false;
    return Step::go_on;
  }
  return alone >= std::min(kSlowBrowser, 0.5 * patience_) && !std::exchange(asked_, true) ? Step::ask
                                                                                          : Step::none;
}

}  // namespace telemime
