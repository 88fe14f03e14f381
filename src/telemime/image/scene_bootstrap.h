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

/// One picture of a clip, of working size, and the head found in it.
struct SceneSample {
  cv::Mat bgr;  ///< CV_8UC3
  std::optional<HeadRegion> head;
};

/// How a scene was learned without a clip of the empty room.
enum class SceneSource {
  nothing,        ///< no face, no empty stretch: nothing could be learned
  empty_stretch,  ///< the person came later, or left early
  moving_person,  ///< around a person who is in every picture
  colours_only,   ///< the camera moves: only the colours of person and surroundings
};

struct SceneReport {
  SceneSource source = SceneSource::nothing;
  std::size_t first = 0;  ///< of the empty stretch, pictures
  std::size_t count = 0;
  double known = 0.0;    ///< share of the picture whose background is known
  std::string sentence;  ///< the same in words
};

/// The longest run of pictures at the start (or, failing that, at the end) in which nothing but noise
/// changes: [first, count]. Count 0 when it is shorter than 8 pictures. A person who sits still looks the
/// same: the caller must check that nobody is in it. The last 3 pictures next to the change are left out.
std::pair<std::size_t, std::size_t> find_still_stretch(std::span<const cv::Mat> pictures);

/// Background of a static camera from pictures with a person who may never leave: every picture's person is
/// cut out, and each pixel takes the colour that recurs most outside the cut. Pixels always covered stay not
/// valid.
BackgroundModel learn_around_person(std::span<const SceneSample> samples);

/// Colours of the surroundings, up to 6 Gaussians, from all pixels of the pictures outside the cut person.
ColourMixture learn_surroundings(std::span<const SceneSample> samples);

}  // namespace telemime
