// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>

#include "telemime/core/camera.h"
#include "telemime/core/random.h"

namespace telemime {

/// The background of the scene: one wall parallel to the image, with a window, shelves of books and posters.
struct Backdrop {
  double distance = 2.4;  ///< of the wall from the camera, m
  cv::Mat albedo;         ///< (height x width) CV_32FC3, what the wall reflects per pixel, linear light, BGR
};

/// Draws a background for this camera. It avoids the hues of skin; `shirt_index` (of Look) keeps its second
/// colour apart from the shirt's. The distance lies in [2.2, 2.6) m.
Backdrop make_backdrop(const Camera& camera, int shirt_index, Random& random);

}  // namespace telemime
