// SPDX-License-Identifier: Apache-2.0
#include "telemime/capture/picture.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <sstream>

#include "telemime/core/errors.h"
#include "telemime/core/time_base.h"

namespace telemime {
namespace {

constexpr int smallest_side = 16;  // pixels: a head would be 2 pixels wide
constexpr double slowest = 0.5;    // frames per second
constexpr double fastest = 1000.0;
constexpr double fallback_fps = 25.0;

double scale_to_8_bits(int depth) {
  if (depth == CV_8U || depth == CV_8S) {
    return 1.0;
  }
  return depth == CV_16U || depth == CV_16S ? 1.0 / 257.0 : 255.0;  // floats are in [0, 1]
}

}  // namespace

std::string in_words(cv::Size size) {
  return std::to_string(size.width) + "x" + std::to_string(size.height);
}

bool same_shape(cv::Size a, cv::Size b) {
  constexpr double kRounding = 0.02;
  return std::abs(static_cast<double>(a.width) * b.height / (static_cast<double>(a.height) * b.width) -
                  1.0) <= kRounding;
}

void Notes::add(const std::string& note) {
  if (std::find(lines_.begin(), lines_.end(), note) == lines_.end()) {
    lines_.push_back(note);
  }
}

std::string Notes::text() const {
  std::string all;
  for (const std::string& line : lines_) {
    all += all.empty() ? line : "\n" + line;
  }
  return all;
}

cv::Mat to_bgr8(const cv::Mat& image) {
  if (image.empty() || image.dims != 2) {
    return {};
  }
  cv::Mat bytes = image;
  if (image.depth() != CV_8U) {
    image.convertTo(bytes, CV_8U, scale_to_8_bits(image.depth()));
  }
  cv::Mat colour;
  switch (bytes.channels()) {
    case 1:
      cv::cvtColor(bytes, colour, cv::COLOR_GRAY2BGR);
      return colour;
    case 3:
      return bytes;
    case 4:
      cv::cvtColor(bytes, colour, cv::COLOR_BGRA2BGR);
      return colour;
    default:
      return {};
  }
}

cv::Mat fit_to(const cv::Mat& image, cv::Size size, Notes& notes) {
  if (image.size() == size) {
    return image;
  }
  notes.add("some frames are not " + in_words(size) + " like the first one (" + in_words(image.size()) +
            " for instance); they were resized");
  const auto scaled = [&image](cv::Size to) {
    cv::Mat resized;
    cv::resize(image, resized, to, 0.0, 0.0, image.cols > to.width ? cv::INTER_AREA : cv::INTER_LINEAR);
    return resized;
  };
  if (same_shape(image.size(), size)) {
    return scaled(size);
  }
  const double scale =
      std::min(static_cast<double>(size.width) / image.cols, static_cast<double>(size.height) / image.rows);
  const auto side = [scale](int pixels, int most) {
    return std::clamp(static_cast<int>(std::lround(scale * pixels)), 1, most);
  };
  const cv::Size inner(side(image.cols, size.width), side(image.rows, size.height));
  cv::Mat fitted(size, image.type(), cv::Scalar::all(0));
  scaled(inner).copyTo(
      fitted(cv::Rect(cv::Point((size.width - inner.width) / 2, (size.height - inner.height) / 2), inner)));
  return fitted;
}

void require_usable_size(cv::Size size, const std::string& input) {
  if (std::min(size.width, size.height) < smallest_side) {
    throw Error(ErrorKind::input, "'" + input + "' has images of " + in_words(size) + " pixels",
                "That is too few to see a person. Use images of at least 160x120 pixels.");
  }
}

cv::Mat with_square_pixels(const cv::Mat& image, double aspect) {
  const cv::Size size(static_cast<int>(std::lround(image.cols * std::max(1.0, aspect))),
                      static_cast<int>(std::lround(image.rows * std::max(1.0, 1.0 / aspect))));
  cv::Mat square = image;
  if (!image.empty() && size != image.size()) {
    cv::resize(image, square, size, 0.0, 0.0, cv::INTER_LINEAR);
  }
  return square;
}

double usable_fps(double stated, std::optional<double> measured, Notes& notes) {
  const bool usable = std::isfinite(stated) && stated >= slowest && stated <= fastest;
  // 0: not known. Faster time stamps count ticks of a clock.
  const double seen = measured && *measured <= fastest ? *measured : 0.0;
  if (usable && (seen == 0.0 || same_rate(stated, seen))) {
    return stated;
  }
  const double used = seen > 0.0 ? seen : fallback_fps;
  std::ostringstream note;
  if (usable) {
    note << "it states " << stated << " frames per second, but its time stamps show " << used
         << ", which is used";
  } else {
    note << "it states no usable frame rate (" << stated << "); " << used << " frames per second are "
         << (seen > 0.0 ? "used, by its time stamps" : "assumed");
  }
  notes.add(note.str());
  return used;
}

}  // namespace telemime
