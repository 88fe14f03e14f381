// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

namespace telemime {

/// Class of a pixel of the working image.
enum class Label : std::uint8_t {
  background = 0,
  head = 1,      ///< face, hair and neck
  arms = 2,      ///< skin outside the head
  clothes = 3,   ///< shirt, jumper: what covers the torso and the sleeves
  ignore = 255,  ///< nobody knows, or not modelled (trousers, a chair): counts neither for nor against
};

/// The head as an upright ellipse, pixels of the working image.
struct HeadRegion {
  Eigen::Vector2d centre{0.0, 0.0};
  Eigen::Vector2d radii{0.0, 0.0};  ///< half width, half height: crown to chin
  bool detected = false;  ///< true: the face detector fired in this frame; false: carried on by tracking
};

/// What the image says, and all that the search sees of it.
struct FrameFeatures {
  cv::Mat labels;      ///< (h x w) CV_8UC1, values of Label
  cv::Mat silhouette;  ///< (h x w) CV_8UC1, 255 where the person is
  cv::Mat edges;       ///< (h x w) CV_8UC1, 255 on edges inside the silhouette
  cv::Mat distance;    ///< (h x w) CV_32FC1, pixels to the nearest edge, capped
  std::optional<HeadRegion> head;
};

}  // namespace telemime
