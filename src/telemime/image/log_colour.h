// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

namespace telemime {

/// Colours on a logarithmic scale: u = ln(R / G), v = ln(B / G), l = mean of ln R, ln G, ln B, each channel
/// raised by kLogColourOffset first. All planes (h x w) CV_32FC1. A shadow moves l only, a change of gain or
/// of white balance adds the same number to a whole plane: both are easy to undo. The offset keeps the noise
/// of dark pixels finite.
struct LogColour {
  cv::Mat u;
  cv::Mat v;
  cv::Mat l;
};

/// Grey levels added to every channel before the logarithm.
inline constexpr float kLogColourOffset = 12.0F;

/// bgr: CV_8UC3. Throws Error(usage) for another type or an empty picture.
LogColour log_colour(const cv::Mat& bgr);

/// One colour [u, v, l].
Eigen::Vector3f log_colour_of(unsigned char blue, unsigned char green, unsigned char red);

/// Takes the planes of `gain` away from those of `picture` (same size).
void subtract(LogColour& picture, const LogColour& gain);

}  // namespace telemime
