// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>

#include "telemime/image/background_model.h"
#include "telemime/image/frame_features.h"
#include "telemime/image/person_colours.h"

namespace telemime {

/// The table of settings (settings_of(ImageConfig&)) gives the meaning, unit and range of each.
struct SegmentationConfig {
  float unknown_cost = 3.0F;
  float unknown_background_cost = 2.0F;
  float person_cost = 1.5F;
  float vote_limit = 14.0F;
  float head_bonus = 8.0F;
  double least_part = 0.0015;
  float focal_length =
      0.866F;  ///< in image widths, set by fitted_to; by default of a field of view of 60 degrees
};

/// Labels and silhouette of one frame, as in FrameFeatures.
struct Segmentation {
  cv::Mat labels;
  cv::Mat silhouette;
  cv::Mat skin;             ///< CV_8UC1, 255 on pixels with the colour of skin
  double head_share = 0.0;  ///< share of the ellipse of the head with the colour of skin or hair
};

/// Labels each pixel as background, head, arms, clothes or ignore: the lowest energy among the background
/// (with or without a shadow) and the colours of the person wins a 3x3 vote. Components that do not belong to
/// the person are then removed, and head, neck and hair are recognised by their position (thesis 2.4.4.1,
/// 3.4.2). Unless `colours_known`, all pixels of the person outside the head are `ignore`.
Segmentation segment(const ColourEnergies& colours, const BackgroundEnergy& background, bool colours_known,
                     const std::optional<HeadRegion>& head, const SegmentationConfig& config);

/// The same from an image.
Segmentation segment(const LogColour& image, const BackgroundEnergy& background, const PersonColours& colours,
                     const std::optional<HeadRegion>& head, const SegmentationConfig& config);

}  // namespace telemime
