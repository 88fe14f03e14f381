// SPDX-License-Identifier: Apache-2.0
#include "telemime/offline/two_way_smoother.h"

namespace telemime {
TwoWaySmoother::TwoWaySmoother(const SmoothingOptions& options, const Body& body, const Camera& camera)
    : options_(options), body_(body), camera_(camera), forward_(make_smoother(options, body, camera)) {}

void TwoWaySmoother::push(const MotionFrame& frame) {
  waiting_.push_back((*forward_)(frame));
}

std::optional<MotionFrame> TwoWaySmoother::next() {
  const auto ahead = static_cast<std::size_t>(options_.look_ahead);
  if (waiting_.empty() || (!finished_ && waiting_.size() <= ahead)) {
    return std::nullopt;
  }
  MotionFrame result = waiting_.front();
  if (ahead > 0) {
    const double time = result.time;
    const auto backward = make_smoother(options_, body_, camera_);
    for (std::size_t i = waiting_.size(); i-- > 0;) {
      result = waiting_[i];
      result.time = -result.time;
      result = (*backward)(result);
    }
    result.time = time;
  }
  waiting_.pop_front();
  return result;
}

}  // namespace telemime
