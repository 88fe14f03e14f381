// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>

#include "telemime/capture/source.h"
#include "telemime/tracker/tracker.h"

namespace telemime {

/// What the look-ahead found out.
struct LookAhead {
  KnownStart start;
  ImageCalibration image;   ///< colours and background, as learned by then
  std::int64_t frames = 0;  ///< in which the person was tracked
  /// The shape was fitted to so many; 0: too few of them showed the arms, it is as the first frame gave it.
  std::size_t keyframes = 0;
  double cost_before = 0.0;
  double cost = 0.0;
};

/// Calibrates on the first good frame, tracks up to config.calibration.look_ahead frames from there and fits
/// the person's shape to the most different of them (refine_shape). `source` stands at the input's first
/// frame; `scene` holds what is known of the background. Nothing when nobody could be calibrated, or `go_on`
/// (asked after each frame with its number) said no.
std::optional<LookAhead> look_ahead(Source& source, const Config& config, const Camera& camera,
                                    const ImageCalibration& scene, std::int64_t most_frames,
                                    const std::function<bool(std::int64_t)>& go_on);

}  // namespace telemime
