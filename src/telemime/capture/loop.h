// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>

#include "telemime/capture/source.h"

namespace telemime {

/// Repeats a file: `open` opens it again at its end. Time and index keep increasing, like those of a camera.
/// Ends if the file cannot be opened again or has no frame. Throws what the first `open` throws.
std::unique_ptr<Source> loop(std::function<std::unique_ptr<Source>()> open);

}  // namespace telemime
