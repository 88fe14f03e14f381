// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "telemime/capture/clock.h"
#include "telemime/capture/source.h"

namespace telemime {

/// Makes a file behave like a camera: a frame appears when its time has come (counted from the first call of
/// next), the newest one wins, older ones are dropped. Time and index of the frames stay those of the file,
/// so gaps in the index show what was dropped. The last frame is always handed out.
std::unique_ptr<Source> pace(std::unique_ptr<Source> file, Clock clock = monotonic_clock());

}  // namespace telemime
