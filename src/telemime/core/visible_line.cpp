// SPDX-License-Identifier: Apache-2.0
#include "telemime/core/visible_line.h"

#include <algorithm>
#include <cmath>

namespace telemime {

double share_in_image(const Camera& camera, const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  const Eigen::Array2d size(camera.width, camera.height);
  const Eigen::Array2d start = from.array() + 0.5;  // from the corner of the image
  if ((start < 0.0).any() || (start > size).any()) {
    return 0.0;
  }
  // The line leaves the image at the first of the borders that it moves toward.
  double share = 1.0;
  for (int axis = 0; axis < 2; ++axis) {
    const double way = to[axis] - from[axis];
    const double room = way > 0.0 ? size[axis] - start[axis] : start[axis];
    share = std::abs(way) > room ? std::min(share, room / std::abs(way)) : share;
  }
  return share;
}

}  // namespace telemime
