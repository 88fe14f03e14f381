// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>

#include "telemime/image/frame_features.h"
#include "telemime/image/log_colour.h"

namespace telemime {

/// The appearance of head and neck without hands in front of them: luminance l of LogColour on a grid that
/// moves with the head. Empty until the first frame.
struct FaceMemory {
  cv::Mat appearance;  ///< CV_32FC1
  double seen = 0.0;   ///< 1/25 s in which it was seen
};

/// Labels the pixels of hands in front of head and neck as arms: pixels labelled head that have the colour of
/// skin (`skin`, CV_8UC1, not 0), differ from the remembered appearance, and are connected with arms outside
/// the head. A frame without an arm near the head updates the memory instead. `labels` (as in FrameFeatures)
/// is modified. `elapsed`: 1/25 s since the last frame.
void label_hands_over_face(FaceMemory& memory, const LogColour& image, const HeadRegion& head,
                           const cv::Mat& skin, cv::Mat& labels, double elapsed = 1.0);

}  // namespace telemime
