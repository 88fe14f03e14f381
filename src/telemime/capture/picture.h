// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

namespace telemime {

/// Notes about an input in the order in which they occurred, without repetitions.
class Notes {
 public:
  void add(const std::string& note);
  /// All notes, one per line; empty if there are none.
  std::string text() const;

 private:
  std::vector<std::string> lines_;
};

/// Converts an image that OpenCV decoded (grey, BGR or BGRA; 8 or 16 bits, or floats in [0, 1]) to (h x w)
/// CV_8UC3 without alpha. Empty for an empty image or another number of channels.
cv::Mat to_bgr8(const cv::Mat& image);

/// For example "640x480".
std::string in_words(cv::Size size);

/// Whether the aspect ratios are equal within 2 %.
bool same_shape(cv::Size a, cv::Size b);

/// `image` resized to `size`, with a note, unless it has that size. An image of another aspect ratio gets
/// black bars: a stretched person could not be tracked.
cv::Mat fit_to(const cv::Mat& image, cv::Size size, Notes& notes);

/// Throws Error(input) that names `input` if an image of this size (pixels) is too small for a person.
void require_usable_size(cv::Size size, const std::string& input);

/// `image` resized so that its pixels are square: `aspect` is the width of a pixel by its height.
cv::Mat with_square_pixels(const cv::Mat& image, double aspect);

/// The frame rate (1/s) of an input: as stated if that is usable (not 0, NaN or a clock rate such as 90000)
/// and the measured one is the same or unknown; else as measured; else 25. With a note where the stated one
/// is not used.
double usable_fps(double stated, std::optional<double> measured, Notes& notes);

}  // namespace telemime
