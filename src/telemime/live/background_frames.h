// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "telemime/core/frame.h"
#include "telemime/offline/record_queue.h"

namespace telemime {

/// Frames from which the background of a live input is learned: one second of them by their time stamps
/// (cameras often state a wrong rate), at least 8 and at most 60. If `next` returns nothing, because the
/// input has ended or the session stops, there may be fewer or none. Large pictures are made smaller, to 640
/// pixels on the longest side: all of them are in memory at once.
inline std::vector<Frame> background_frames(const std::function<std::optional<Frame>()>& next) {
  constexpr std::size_t kFewest = 8;
  constexpr std::size_t kMost = 60;  // even if the times do not advance
  constexpr double kSeconds = 1.0;
  constexpr int kLongestSide = 640;  // pixels
  std::vector<Frame> frames;
  while (frames.size() < kFewest ||
         (frames.size() < kMost && frames.back().time - frames.front().time < kSeconds)) {
    auto frame = next();
    if (!frame) {
      break;
    }
    keep_picture(kLongestSide, *frame);
    frames.push_back(std::move(*frame));
  }
  return frames;
}

}  // namespace telemime
