// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>

#include "telemime/capture/source.h"

namespace telemime {

/// A file again and again: when it ends, `open` opens it anew. Time and index go on rising, as if the camera
/// had been running all the time. It ends when the file cannot be opened again or holds no frame. Throws what
/// the first `open` throws.
std::unique_ptr<Source> loop(std::function<std::unique_ptr<Source>()> open);

}  // namespace telemime
