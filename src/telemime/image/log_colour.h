// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace telemime {

/// An image in logarithmic colours: u = ln(R / G), v = ln(B / G), l = mean of ln R, ln G and ln B, where
/// kLogColourOffset is added to each channel first. All planes are (h x w) CV_32FC1. A shadow changes only l,
/// and a change of gain or white balance adds a constant to a whole plane, so both are easy to compensate.
/// The offset limits the noise of dark pixels.
struct LogColour {
  cv::Mat u;
  cv::Mat v;
  cv::Mat l;
};

/// Grey levels added to every channel before the logarithm.
inline constexpr float kLogColourOffset = 12.0F;

/// Converts an image (CV_8UC3, BGR). Throws Error(usage) for another type or an empty image.
LogColour log_colour(const cv::Mat& bgr);

/// Converts one colour to [u, v, l].
Eigen::Vector3f log_colour_of(unsigned char blue, unsigned char green, unsigned char red);

/// Upper median of at least one value; reorders the values.
float median(std::vector<float>& values);

}  // namespace telemime
