// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "telemime/core/frame.h"

namespace telemime {

/// Pictures from which the background of a live input is learned: of one second, as the frames' times say
/// (cameras often state another rate than they give), but 8 at least and 60 at most. `next` gives nothing at
/// the input's end or when all is to stop: then they may be fewer, or none.
std::vector<Frame> room_pictures(const std::function<std::optional<Frame>()>& next);

}  // namespace telemime
