// SPDX-License-Identifier: Apache-2.0
#include "telemime/offline/two_way_smoothing.h"

#include <algorithm>

namespace telemime {

TwoWaySmoothing make_two_way_smoothing(const SmoothingOptions& options, const Body& body,
                                       const Camera& camera) {
  return {
      .options = options, .body = body, .camera = camera, .forward = make_smoother(options, body, camera)};
}

void smooth_forward(TwoWaySmoothing& smoothing, RecordQueue& queue) {
  for (; queue.smoothed < queue.chosen; ++queue.smoothed) {
    MotionFrame& motion = queue.records[queue.smoothed].estimate.motion;
    motion = (*smoothing.forward)(motion);
  }
}

std::optional<MotionFrame> smoothed_front(const TwoWaySmoothing& smoothing, const RecordQueue& queue,
                                          bool last) {
  const auto ahead = static_cast<std::size_t>(smoothing.options.look_ahead);
  if (queue.smoothed == 0 || (!last && queue.smoothed <= ahead)) {
    return std::nullopt;
  }
  MotionFrame result = queue.records.front().estimate.motion;
  if (ahead == 0) {
    return result;
  }
  const double time = result.time;
  const auto backward = make_smoother(smoothing.options, smoothing.body, smoothing.camera);
  for (std::size_t i = std::min(queue.smoothed, ahead + 1); i-- > 0;) {
    result = queue.records[i].estimate.motion;
    result.time = -result.time;
    result = (*backward)(result);
  }
  result.time = time;
  return result;
}

}  // namespace telemime
