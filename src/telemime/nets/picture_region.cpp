// SPDX-License-Identifier: Apache-2.0
#include "telemime/nets/picture_region.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <opencv2/imgproc.hpp>

#include "telemime/core/errors.h"

namespace telemime {
namespace {

// From the centre of a cell of a grid over the region to a pixel of the picture.
cv::Matx23d picture_from_cell(const PictureRegion& region, cv::Size grid) {
  const Eigen::Matrix2d turn = region.rotation();
  const double dx = region.width / grid.width;
  const double dy = region.height / grid.height;
  const Eigen::Vector2d first = region.pixel({0.5 / grid.width, 0.5 / grid.height});
  return {turn(0, 0) * dx, turn(0, 1) * dy, first.x(), turn(1, 0) * dx, turn(1, 1) * dy, first.y()};
}

}  // namespace

Eigen::Matrix2d PictureRegion::rotation() const {
  Eigen::Matrix2d turn;
  turn << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
  return turn;
}

Eigen::Vector2d PictureRegion::pixel(const Eigen::Vector2d& own) const {
  return centre + rotation() * Eigen::Vector2d((own.x() - 0.5) * width, (own.y() - 0.5) * height);
}

PictureRegion square_around(const cv::Mat& picture) {
  const double side = std::max(picture.cols, picture.rows);
  return {.centre = {0.5 * (picture.cols - 1), 0.5 * (picture.rows - 1)}, .width = side, .height = side};
}

PictureRegion region_of_axis(const Eigen::Vector2d& centre, const Eigen::Vector2d& top) {
  constexpr double kMargin = 1.25;
  const Eigen::Vector2d axis = top - centre;
  const double side = 2.0 * axis.norm() * kMargin;
  const double angle = 0.5 * std::numbers::pi - std::atan2(-axis.y(), axis.x());
  return {.centre = centre, .width = side, .height = side, .angle = angle};
}

std::vector<float> network_input(const cv::Mat& picture, const PictureRegion& region,
                                 const InputFormat& format) {
  if (picture.empty() || picture.type() != CV_8UC3) {
    throw Error(ErrorKind::usage, "a network was given no picture in colour with 8 bits per channel");
  }
  cv::Mat crop;
  cv::warpAffine(picture, crop, picture_from_cell(region, format.size), format.size,
                 cv::INTER_LINEAR | cv::WARP_INVERSE_MAP,
                 format.repeats_border ? cv::BORDER_REPLICATE : cv::BORDER_CONSTANT);
  cv::cvtColor(crop, crop, cv::COLOR_BGR2RGB);
  std::vector<float> input(3 * static_cast<std::size_t>(format.size.area()));
  cv::Mat numbers(format.size, CV_32FC3, input.data());
  crop.convertTo(numbers, CV_32F, (format.white - format.black) / 255.0F);
  numbers += cv::Scalar::all(format.black);
  return input;
}

cv::Mat picture_mask(const cv::Mat& cells, const PictureRegion& region, cv::Size picture) {
  cv::Mat result;
  cv::warpAffine(cells, result, picture_from_cell(region, cells.size()), picture, cv::INTER_LINEAR,
                 cv::BORDER_CONSTANT);
  return result;
}

cv::Range rows_in_picture(const PictureRegion& region, cv::Size grid, cv::Size picture) {
  cv::Matx23d to_cell;
  cv::invertAffineTransform(picture_from_cell(region, grid), to_cell);
  double first = std::numeric_limits<double>::max();
  double last = std::numeric_limits<double>::lowest();
  for (const double x : {0.0, picture.width - 1.0}) {
    for (const double y : {0.0, picture.height - 1.0}) {
      const double row = to_cell(1, 0) * x + to_cell(1, 1) * y + to_cell(1, 2);
      first = std::min(first, row);
      last = std::max(last, row);
    }
  }
  // A pixel reads the rows before and after its place; warpAffine rounds that by less than a row.
  const auto clipped = [&](double row) {
    return static_cast<int>(std::clamp(row, 0.0, static_cast<double>(grid.height)));
  };
  return {clipped(std::floor(first) - 1.0), clipped(std::floor(last) + 3.0)};
}

}  // namespace telemime
