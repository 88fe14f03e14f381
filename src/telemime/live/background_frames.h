// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "telemime/core/frame.h"
#include "telemime/image/feature_config.h"
#include "telemime/offline/record_queue.h"

namespace telemime {

/// The longest side of pictures (pixels) with which a background is as good as with larger ones.
inline int background_side(const ImageConfig& image) {
  constexpr int kNetworks = 640;
  return std::max({kNetworks, image.width, image.height, 2 * image.face_width});
}

/// Frames from which the background of a live input is learned: one second of them by their time stamps
/// (cameras often state a wrong rate), at least 8 and at most 60. If `next` returns nothing, because the
/// input has ended or the session stops, there may be fewer or none. Larger pictures are made smaller: all
/// of them are in memory at once.
inline std::vector<Frame> background_frames(const std::function<std::optional<Frame>()>& next,
                                            const ImageConfig& image) {
  constexpr std::size_t kFewest = 8;
  constexpr std::size_t kMost = 60;  // even if the times do not advance
  constexpr double kSeconds = 1.0;
  std::vector<Frame> frames;
  while (frames.size() < kFewest ||
         (frames.size() < kMost && frames.back().time - frames.front().time < kSeconds)) {
    auto frame = next();
    if (!frame) {
      break;
    }
    keep_picture(background_side(image), *frame);
    frames.push_back(std::move(*frame));
  }
  return frames;
}

}  // namespace telemime
