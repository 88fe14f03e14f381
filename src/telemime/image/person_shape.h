// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>

#include "telemime/image/frame_features.h"

namespace telemime {

/// Mask of the person (CV_8UC1, 255 on the person, size of `bgr`) in an image without a known background, by
/// GrabCut (C. Rother et al., SIGGRAPH 2004) initialised with the body below the head. `bgr` is CV_8UC3,
/// `head` in its pixels. The segmentation runs on at most 160 columns. Deterministic.
cv::Mat cut_person(const cv::Mat& bgr, const HeadRegion& head);

/// Prior for the person given only the position of the head (size.height x size.width, CV_32FC1): 1 on head
/// and chest, 0.4 near them, -0.2 where only arms can be, and -1 where no part of the body can be.
cv::Mat body_prior(const cv::Size& size, const HeadRegion& head);

/// Where a person mask (CV_8UC1, 255 is certain) may see the person, grown by a margin in pixels: 255.
cv::Mat person_area(const cv::Mat& mask, int margin);

}  // namespace telemime
