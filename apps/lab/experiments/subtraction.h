// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <opencv2/core/mat.hpp>
#include <span>
#include <string_view>
#include <vector>

namespace telemime {

/// The background subtractions that the thesis compares (3.4.3, Table 3-1, Figure 3-6), and ours.
enum class Subtraction {
  rgb_difference,  ///< largest difference of a channel from the mean picture
  mixture,         ///< OpenCV's MOG2 (Z. Zivkovic, 2004), shadows on
  reference,       ///< chroma and gradient direction, thesis 3.4.2
  robust,          ///< chroma and luminance with shadows and local gain (background_model.h); the default
};
inline constexpr std::string_view kSubtractionNames[] = {"rgb-difference", "mixture", "reference", "robust"};

/// Foreground of pictures by one of the methods, all with the same clean-up: opening, then closing, with a
/// 3x3 square. For comparisons; FeatureExtractor uses the robust energies directly.
class Subtractor {
 public:
  Subtractor() = default;
  Subtractor(const Subtractor&) = delete;
  Subtractor& operator=(const Subtractor&) = delete;
  virtual ~Subtractor() = default;
  /// 255 on foreground; bgr CV_8UC3 of the size learned. May adapt: pictures in the order of time.
  virtual cv::Mat foreground(const cv::Mat& bgr) = 0;
};

/// Learns from pictures (CV_8UC3, one size) without a person. Throws Error(usage) when there is none.
std::unique_ptr<Subtractor> make_subtractor(Subtraction method, std::span<const cv::Mat> pictures);

}  // namespace telemime
