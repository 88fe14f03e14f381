// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "telemime/image/background_model.h"
#include "telemime/image/colour_model.h"
#include "telemime/image/frame_features.h"

namespace telemime {

/// One image of a clip, at the working size, and the head detected in it.
struct SceneSample {
  cv::Mat bgr;  ///< CV_8UC3
  std::optional<HeadRegion> head;
  /// Where a network sees the person: CV_8UC1, 255 is certain; zeros: it sees nobody. Empty: no network
  /// looked.
  cv::Mat mask;
};

/// Start and length [first, count] of the run of images at the start (or, failing that, at the end) of
/// `images` in which only noise changes, without the 3 images next to the change. Count 0 if fewer than 8
/// remain. The caller must check that no person is in these images: one who sits still changes nothing.
std::pair<std::size_t, std::size_t> find_still_stretch(std::span<const cv::Mat> images);

/// Background of a static camera from images with a person who may never leave. The person is segmented in
/// each image, and each pixel gets the colour that recurs most outside the person. Pixels that are always
/// covered stay invalid.
BackgroundModel learn_around_person(std::span<const SceneSample> samples);

/// Colours of the surroundings of the person, up to 6 Gaussians, from the pixels outside the person.
ColourMixture learn_surroundings(std::span<const SceneSample> samples);

}  // namespace telemime
