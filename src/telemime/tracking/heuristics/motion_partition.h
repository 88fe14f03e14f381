// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "telemime/tracking/heuristics/heuristic.h"

namespace telemime {

/// Restricts diffusion to parts that uncovered pixels of their class since the last frame (thesis 4.4.2.2.1,
/// equations 4.15 to 4.20); when the trunk moves, all parts are diffused.
void find_moving_parts(const FilterContext& context, Generation& generation);

/// y_k / |A_{t-1} n B_k| of equations 4.15 and 4.20 for each part: of its visible pixels in this pose that
/// had the part's class in the labels `before`, the share that does not have it `now`. Labels are (h x w)
/// CV_8UC1 of the camera's size.
std::array<double, kPartCount> uncovered_shares(const cv::Mat& before, const cv::Mat& now, const Model& model,
                                                const Pose& pose, const Camera& camera);

}  // namespace telemime
