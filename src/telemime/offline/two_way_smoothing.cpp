// SPDX-License-Identifier: Apache-2.0
#include "telemime/offline/two_way_smoothing.h"

#include <algorithm>

#include "telemime/core/time_base.h"

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
  if (queue.smoothed == 0) {
    return std::nullopt;
  }
  MotionFrame result = queue.records.front().estimate.motion;
  const double time = result.time;
  // Until the first frame at the end of the look-ahead.
  const double until = time + kTimeUnit * (smoothing.options.look_ahead - 0.01);
  const auto smoothed_end = queue.records.begin() + static_cast<std::ptrdiff_t>(queue.smoothed);
  const auto at_end = std::find_if(queue.records.begin(), smoothed_end, [until](const FrameRecord& record) {
    return record.estimate.motion.time >= until;
  });
  if (at_end == smoothed_end && !last) {
    return std::nullopt;
  }
  if (smoothing.options.look_ahead == 0) {
    return result;
  }
  const auto ahead = static_cast<std::size_t>(at_end - queue.records.begin());
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
