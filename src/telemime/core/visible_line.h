// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "telemime/core/camera.h"

namespace telemime {

/// Share of the straight line from one pixel to another that lies in the camera's image, counted from `from`:
/// 1 when both do, 0 when `from` does not.
double share_in_image(const Camera& camera, const Eigen::Vector2d& from, const Eigen::Vector2d& to);

}  // namespace telemime
