// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>

namespace telemime {

/// The motion that the background of two images has in common.
struct SharedMotion {
  double pixels = 0.0;  ///< root mean square of the displacement over the corners; 0: the camera stands still
  double share = 0.0;   ///< of the corners: how many this motion explains, [0, 1]
};

/// The motion of the camera between two images (CV_8UC1, same size), from corners where `scene` (CV_8UC1) is
/// not 0. Corners spread over the image are followed forward and back by optical flow; the camera moves if
/// one similarity transform (shift, turn, zoom) explains most of them, rest does not, and the motion exceeds
/// the errors of the corners. So neither an arm nor a curtain is a moving camera. The images are normalised
/// by their local mean and contrast: brightness does not count. Empty: too few corners can be followed to
/// tell, as on a plain wall.
std::optional<SharedMotion> shared_motion(const cv::Mat& before, const cv::Mat& after, const cv::Mat& scene);

}  // namespace telemime
