// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>

namespace telemime {

/// How far the scene moved between two pictures (CV_8UC1, one size): the lower quartile, in pixels, of the
/// ways of corners that lie where `scene` (CV_8UC1) is not 0, by pyramidal Lucas-Kanade. When the camera
/// moves all corners do; a passing arm moves some. Nothing when fewer than 8 corners can be followed: a bare
/// wall says nothing about the camera.
std::optional<double> scene_motion(const cv::Mat& before, const cv::Mat& after, const cv::Mat& scene);

}  // namespace telemime
