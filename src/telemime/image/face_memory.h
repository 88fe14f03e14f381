// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>

#include "telemime/image/frame_features.h"
#include "telemime/image/log_colour.h"

namespace telemime {

/// What the head and neck look like when no hand is before them, in a frame that moves with the head: the
/// plane l of LogColour on a fixed grid over the head's ellipse and the neck. A value; empty until first
/// used.
struct FaceMemory {
  cv::Mat look;    ///< CV_32FC1
  int frames = 0;  ///< that went into it
};

/// Gives the pixels of hands before head and neck back to the arms: pixels labelled head, of skin colour
/// (`skin`, CV_8UC1, not 0), that differ from the remembered look and hang together with arms outside. Frames
/// in which no arm is near the head refresh the memory instead. `labels` as in FrameFeatures, changed in
/// place.
void uncover_hands(FaceMemory& memory, const LogColour& picture, const HeadRegion& head, const cv::Mat& skin,
                   cv::Mat& labels);

}  // namespace telemime
