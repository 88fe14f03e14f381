// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>

#include "telemime/image/frame_features.h"

namespace telemime {

/// Person (255) or not (0) in one picture whose scene is not known, by GrabCut (C. Rother et al., SIGGRAPH
/// 2004) started from where a head with this ellipse has its shoulders and chest. The cut runs on at most 160
/// columns; the result has the picture's size, CV_8UC1. bgr: CV_8UC3; head in its pixels. Deterministic.
cv::Mat cut_person(const cv::Mat& bgr, const HeadRegion& head);

/// How likely a place is the person's, only from where the head is: +1 in head and chest, -1 far from them,
/// 0 where arms come and go. (height x width) CV_32FC1.
cv::Mat body_prior(const cv::Size& size, const HeadRegion& head);

}  // namespace telemime
