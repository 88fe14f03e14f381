// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "telemime/capture/source.h"
#include "telemime/core/lens.h"

namespace telemime {

/// The pictures of a source as a lens without distortion would show them, with the same focal length and
/// centre. `lens.camera` must have the size of the pictures. Throws Error(config) where the lens leaves less
/// than a quarter of the picture.
std::unique_ptr<Source> undistorted(std::unique_ptr<Source> source, const Lens& lens);

}  // namespace telemime
