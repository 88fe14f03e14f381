// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

namespace telemime {

/// Notes about an input, each once, in the order in which they came up.
class Notes {
 public:
  void add(const std::string& note);
  /// All notes, one a line; empty when there are none.
  std::string text() const;

 private:
  std::vector<std::string> lines_;
};

/// Any picture that OpenCV decodes (grey, BGR or BGRA; 8 or 16 bits, or floats in [0, 1]) as (h x w) CV_8UC3.
/// Alpha is dropped. Returns an empty Mat for an empty one or for another number of channels.
cv::Mat to_bgr8(const cv::Mat& image);

/// "640x480"
std::string in_words(cv::Size size);

/// Equal ratios of width and height, up to rounding (2 %).
bool same_shape(cv::Size a, cv::Size b);

/// `image` resized to `size` when it has another one (and then a note is added), else itself. One of another
/// shape keeps its proportions, with black bars: a person who is stretched is nobody.
cv::Mat fit_to(const cv::Mat& image, cv::Size size, Notes& notes);

/// Throws Error(input) when a picture of this size (pixels) is too small to hold a person; `input` names it.
void require_usable_size(cv::Size size, const std::string& input);

/// The frame rate (1/s) that an input states, or 25 with a note when it states nothing usable (0, a NaN, a
/// clock rate such as 90000).
double usable_fps(double stated, Notes& notes);

}  // namespace telemime
