// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

namespace telemime {

/// A rectangle of a picture that a network sees: turned about its centre, stretched to the network's input.
struct PictureRegion {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();  ///< pixels of the picture
  double width = 0.0;                                ///< pixels
  double height = 0.0;                               ///< pixels
  double angle = 0.0;                                ///< radians, clockwise as seen

  /// From the region's own coordinates, [0, 1] from edge to edge, to a pixel of the picture.
  Eigen::Vector2d pixel(const Eigen::Vector2d& own) const;
  /// The turn from the region's axes to the picture's.
  Eigen::Matrix2d rotation() const;
};

/// The smallest square about the middle of the picture that contains it.
PictureRegion square_around(const cv::Mat& picture);

/// The square around a person whose hips are at `centre` and who is upright in it: the circle about `centre`
/// through `top` contains the person, and a quarter is added to it.
PictureRegion region_of_axis(const Eigen::Vector2d& centre, const Eigen::Vector2d& top);

/// How a region becomes the input of a network.
struct InputFormat {
  cv::Size size;               ///< pixels
  float black = 0.0F;          ///< value of 0
  float white = 1.0F;          ///< value of 255
  bool repeats_border = true;  ///< outside the picture its border pixels are repeated; otherwise it is black
};

/// The region of a BGR picture (CV_8UC3) by bilinear interpolation, as [height, width, RGB]. Throws
/// Error(usage) if the picture is empty or of another type.
std::vector<float> network_input(const cv::Mat& picture, const PictureRegion& region,
                                 const InputFormat& format);

/// A probability for each cell of a region (CV_8UC1, 255 is 1) as an image of the picture's size (CV_8UC1); 0
/// outside of the region.
cv::Mat picture_mask(const cv::Mat& cells, const PictureRegion& region, cv::Size picture);

/// The rows of a grid over the region that a picture of this size shows, and that picture_mask() reads.
cv::Range rows_in_picture(const PictureRegion& region, cv::Size grid, cv::Size picture);

}  // namespace telemime
