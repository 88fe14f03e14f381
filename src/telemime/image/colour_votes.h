// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>

#include "telemime/image/frame_features.h"
#include "telemime/image/person_colours.h"
#include "telemime/image/segmentation.h"

namespace telemime {

/// What colour says of a pixel, before its place is looked at.
enum Colour : unsigned char { kSkin = 0, kClothes = 1, kHair = 2, kOther = 3 };

struct ColourVotes {
  cv::Mat best;     ///< CV_32FC1, energy of the best of the person's colours
  cv::Mat colour;   ///< CV_8UC1, which
  cv::Mat learned;  ///< CV_8UC1, which of those that were learned, hair excluded; kOther: trousers or a mask
};

struct Ellipse {
  explicit Ellipse(const HeadRegion& head)
      : x(static_cast<float>(head.centre.x())),
        y(static_cast<float>(head.centre.y())),
        rx(static_cast<float>(head.radii.x())),
        ry(static_cast<float>(head.radii.y())) {}
  /// Below 1 inside.
  float at(int row, int column) const {
    const float dx = (static_cast<float>(column) - x) / rx;
    const float dy = (static_cast<float>(row) - y) / ry;
    return dx * dx + dy * dy;
  }
  float x, y, rx, ry;
};

/// Votes of every pixel of the picture; hair only counts around the head.
ColourVotes vote(const LogColour& picture, const PersonColours& colours,
                 const std::optional<HeadRegion>& head, const SegmentationConfig& config);

}  // namespace telemime
