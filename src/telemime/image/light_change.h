// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "telemime/image/background_model.h"
#include "telemime/image/log_colour.h"

namespace telemime {

/// How an image differs from the scene in the light in which its model was learned, each channel by itself:
/// grey level now = gain x grey level then + offset. The gain is that of a lamp, a large shadow, the exposure
/// or the white balance of the camera; the offset is its setting "brightness" (a black level), or haze.
struct LightChange {
  LogColour gain;                        ///< logarithms of the factors, as u, v and l; smooth over the image
  std::array<float, 3> offset{0, 0, 0};  ///< of blue, green and red, grey levels; the same at all pixels
};

/// Estimates the change from the pixels that are valid, neither black nor white, and where `background`
/// (CV_8UC1; empty: everywhere) is not 0. The offset is that of a line through the medians of classes of
/// similar grey level, or 0 unless it explains much more than a gain alone. The gain is the median ratio in
/// each cell of a coarse grid, smoothed over the grid and interpolated to the image; cells with too few
/// pixels use their neighbours. Without any pixel nothing has changed.
LightChange estimate_light(const BackgroundModel& model, const LogColour& image, const cv::Mat& background);

/// Gives the image the light of the model. A channel that is clipped, black or white, in the image or in the
/// model may have been darker or brighter: then it is as dark or bright as in the model.
void compensate(const BackgroundModel& model, const LightChange& light, LogColour& image);

}  // namespace telemime
