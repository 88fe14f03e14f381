// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <deque>
#include <memory>
#include <optional>

#include "telemime/offline/body_smoothing.h"
#include "telemime/offline/record_queue.h"
#include "telemime/tracker/hand_noise.h"
#include "telemime/tracker/smoother.h"

namespace telemime {

/// Smooths with what comes after a frame as well as with what came before. Frames come out
/// SmoothingOptions::look_ahead (1/25 s) late; with 0 it is the plain filter. Otherwise body and hands of
/// "one-euro" are smoothed over the interval (smoothed_first). The face, and all of "recursive", are filtered
/// forward in time, and then backward over the result: what lags one way runs ahead the other way.
struct TwoWaySmoothing {
  SmoothingOptions options;
  Body body;
  Camera camera;  ///< of the input's frames
  std::unique_ptr<Smoother> forward;
  std::deque<std::optional<MeasuredPose>> measured;  ///< of the smoothed records; empty: nobody was found
  std::optional<BodyState> before;                   ///< at the frame before these
  std::array<HandNoise, 2> hand_noise;               ///< of the last of these
};

/// Throws Error(config) when a name or a number is not usable.
TwoWaySmoothing make_two_way_smoothing(const SmoothingOptions& options, const Body& body,
                                       const Camera& camera);

/// Smooths the chosen records of the queue forward in time, in place.
void smooth_forward(TwoWaySmoothing& smoothing, RecordQueue& queue);

/// The first record's motion with all its future, once: the record must then be removed. Nothing when it must
/// still wait. `last`: no frame follows.
std::optional<MotionFrame> smoothed_front(TwoWaySmoothing& smoothing, const RecordQueue& queue, bool last);

}  // namespace telemime
