// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>

#include "telemime/core/camera.h"
#include "telemime/core/random.h"

namespace telemime {

/// The room behind the person: one wall parallel to the image, with a window, shelves of books and posters.
struct Room {
  double distance = 2.4;  ///< of the wall from the camera, m
  cv::Mat albedo;         ///< (height x width) CV_32FC3, what the wall reflects per pixel, linear light, BGR
};

/// Draws a room for this camera. Everything in it avoids the hues of skin; `shirt_index` (of Look) keeps the
/// room's second colour apart from the shirt's. The distance lies in [2.2, 2.6) m.
Room make_room(const Camera& camera, int shirt_index, Random& random);

}  // namespace telemime
