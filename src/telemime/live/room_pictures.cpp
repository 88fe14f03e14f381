// SPDX-License-Identifier: Apache-2.0
#include "telemime/live/room_pictures.h"

#include <cstddef>
#include <utility>

namespace telemime {

std::vector<Frame> room_pictures(const std::function<std::optional<Frame>()>& next) {
  constexpr std::size_t kFewest = 8;
  constexpr std::size_t kMost = 60;  // also where the times do not advance
  constexpr double kSeconds = 1.0;
  std::vector<Frame> frames;
  while (frames.size() < kFewest ||
         (frames.size() < kMost && frames.back().time - frames.front().time < kSeconds)) {
    auto frame = next();
    if (!frame) {
      break;
    }
    frames.push_back(std::move(*frame));
  }
  return frames;
}

}  // namespace telemime
