// SPDX-License-Identifier: Apache-2.0
#pragma once

// Small files for the tests of this folder. Not installed.

#include <cmath>
#include <fstream>
#include <functional>
#include <opencv2/core/mat.hpp>
#include <opencv2/videoio.hpp>
#include <string>
#include <utility>

#include "telemime/capture/live.h"
#include "telemime/core/scratch_folder.h"

namespace telemime::testing {

inline void write_bytes(const std::string& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
}

/// An image whose grey level, 10 + 20 * number, identifies its number after lossy coding.
inline cv::Mat numbered_picture(int number, cv::Size size = {64, 48}) {
  return cv::Mat(size, CV_8UC3, cv::Scalar::all(10 + 20 * (number % 12)));
}

/// The number (below 12) of an image made by numbered_picture.
inline int number_of(const cv::Mat& image) {
  return static_cast<int>(std::lround((cv::mean(image)[0] - 10.0) / 20.0));
}

/// Writes a Motion JPEG clip of `frames` numbered images.
inline void write_clip(const std::string& file, int frames, double fps = 20.0) {
  cv::VideoWriter writer(file, cv::CAP_OPENCV_MJPEG, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), fps,
                         {64, 48});
  for (int i = 0; i < frames; ++i) {
    writer.write(numbered_picture(i));
  }
}

/// A device that delivers this number of images, then calls `end`.
inline LiveDevice device_of(
    int pictures, std::function<bool()> end = [] { return false; }) {
  return {[pictures, end = std::move(end)]() mutable { return pictures-- > 0 || end(); },
          [](cv::Mat& picture) {
            picture = numbered_picture(1);
            return true;
          },
          {},
          25.0};
}

inline void cut_to(const std::string& file, double fraction) {
  std::filesystem::resize_file(
      file, static_cast<std::uintmax_t>(fraction * static_cast<double>(std::filesystem::file_size(file))));
}

}  // namespace telemime::testing
