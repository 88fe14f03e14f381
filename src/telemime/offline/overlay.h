// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>
#include <string>

#include "telemime/body/motion_frame.h"
#include "telemime/core/camera.h"
#include "telemime/likelihood/backend.h"
#include "telemime/nets/face_landmarks.h"

namespace telemime {

/// What a picture of the tracking shows besides the input image.
struct OverlayView {
  const MotionFrame* motion = nullptr;
  const Model* model = nullptr;         ///< for the contour
  Camera camera;                        ///< of the input's frames; the drawn image may be smaller
  const FaceLandmarks* face = nullptr;  ///< that was seen in the input image
  std::string note;                     ///< words for the lower edge
};

/// The input image with the model's occluding contour, the skeleton (left arm and right arm in different
/// colours), eyes, brows and lips, and a panel to its right: the scene from above (metres) and the residuals.
/// BGR; the input's height, about 1.4 times as wide. Sizes scale with the image.
cv::Mat draw_overlay(const cv::Mat& image, const OverlayView& view);

}  // namespace telemime
