// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "telemime/offline/record_queue.h"
#include "telemime/tracker/smoother.h"

namespace telemime {

/// Smooths with what comes after a frame as well as with what came before: the filter runs forward in time,
/// and then backward over its own result. What lags one way runs ahead the other way, so the lag goes, and
/// the filter acts twice. Frames come out SmoothingOptions::look_ahead (1/25 s) late; with 0 it is the plain
/// filter.
struct TwoWaySmoothing {
  SmoothingOptions options;
  Body body;
  Camera camera;  ///< of the input's frames
  std::unique_ptr<Smoother> forward;
};

/// Throws Error(config) when a name or a number is not usable.
TwoWaySmoothing make_two_way_smoothing(const SmoothingOptions& options, const Body& body,
                                       const Camera& camera);

/// Smooths the chosen records of the queue forward in time, in place.
void smooth_forward(TwoWaySmoothing& smoothing, RecordQueue& queue);

/// The first record's motion with all its future; nothing when it must still wait. `last`: no frame follows.
std::optional<MotionFrame> smoothed_front(const TwoWaySmoothing& smoothing, const RecordQueue& queue,
                                          bool last);

}  // namespace telemime
