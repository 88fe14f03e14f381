// SPDX-License-Identifier: Apache-2.0
#include "telemime/image/log_colour.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core.hpp>

#include "telemime/core/errors.h"

namespace telemime {
namespace {

std::array<float, 256> logarithms() {
  std::array<float, 256> table{};
  for (int i = 0; i < 256; ++i) {
    table[static_cast<std::size_t>(i)] = std::log(static_cast<float>(i) + kLogColourOffset);
  }
  return table;
}

}  // namespace

LogColour log_colour(const cv::Mat& bgr) {
  if (bgr.empty() || bgr.type() != CV_8UC3) {
    throw Error(ErrorKind::usage,
                "logarithmic colours need an image with 8 bits each of blue, green and red");
  }
  const std::array<float, 256> table = logarithms();
  LogColour out{cv::Mat(bgr.size(), CV_32FC1), cv::Mat(bgr.size(), CV_32FC1), cv::Mat(bgr.size(), CV_32FC1)};
  for (int r = 0; r < bgr.rows; ++r) {
    const auto* in = bgr.ptr<unsigned char>(r);
    auto* u = out.u.ptr<float>(r);
    auto* v = out.v.ptr<float>(r);
    auto* l = out.l.ptr<float>(r);
    for (int c = 0; c < bgr.cols; ++c, in += 3) {
      const float blue = table[in[0]];
      const float green = table[in[1]];
      const float red = table[in[2]];
      u[c] = red - green;
      v[c] = blue - green;
      l[c] = (blue + green + red) * (1.0F / 3.0F);
    }
  }
  return out;
}

Eigen::Vector3f log_colour_of(unsigned char blue, unsigned char green, unsigned char red) {
  const auto log_of = [](unsigned char value) {
    return std::log(static_cast<float>(value) + kLogColourOffset);
  };
  const float b = log_of(blue);
  const float g = log_of(green);
  const float r = log_of(red);
  return {r - g, b - g, (b + g + r) / 3};
}

float median(std::vector<float>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace telemime
