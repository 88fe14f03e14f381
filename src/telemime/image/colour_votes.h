// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>

#include "telemime/image/frame_features.h"
#include "telemime/image/person_colours.h"
#include "telemime/image/segmentation.h"

namespace telemime {

/// The colour class of a pixel, irrespective of its position.
enum Colour : unsigned char { kSkin = 0, kClothes = 1, kHair = 2, kOther = 3 };

/// The colour classes of all pixels after a vote among neighbours.
struct ColourVotes {
  cv::Mat best;     ///< CV_32FC1, lowest energy of the colours of the person, without the vote
  cv::Mat colour;   ///< CV_8UC1, the Colour after the vote
  cv::Mat learned;  ///< CV_8UC1, the best Colour that was learned, without hair; kOther: trousers or a mask
};

/// The ellipse of the head.
struct Ellipse {
  explicit Ellipse(const HeadRegion& head)
      : x(static_cast<float>(head.centre.x())),
        y(static_cast<float>(head.centre.y())),
        rx(static_cast<float>(head.radii.x())),
        ry(static_cast<float>(head.radii.y())) {}
  /// Squared distance from the centre in radii: less than 1 inside.
  float at(int row, int column) const {
    const float dx = (static_cast<float>(column) - x) / rx;
    const float dy = (static_cast<float>(row) - y) / ry;
    return dx * dx + dy * dy;
  }
  float x, y, rx, ry;
};

/// Computes the colour classes of an image with these energies. Hair is a candidate only around the head,
/// other classes everywhere.
ColourVotes vote(const ColourEnergies& energies, const std::optional<HeadRegion>& head,
                 const SegmentationConfig& config);

}  // namespace telemime
