// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>
#include <span>
#include <string>
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

/// How the background was learned without a background clip.
enum class SceneSource {
  nothing,        ///< neither a face nor an empty stretch: nothing was learned
  empty_stretch,  ///< from frames before the person enters or after the person leaves
  moving_person,  ///< around a person who is in every image
  colours_only,   ///< the camera moves: only colours of person and surroundings are known
};

/// Result of FeatureExtractor::bootstrap.
struct SceneReport {
  SceneSource source = SceneSource::nothing;
  std::size_t first = 0;  ///< index of the first frame of the empty stretch
  std::size_t count = 0;  ///< frames in the empty stretch
  double known = 0.0;     ///< share of the image whose background is known
  std::string sentence;   ///< the same as a message for the user
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
