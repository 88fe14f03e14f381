// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>

#include "telemime/image/frame_features.h"
#include "telemime/image/head_tracker.h"

namespace telemime {

/// How a person's head lies around the square of the face detector, in sides of that square. Hair decides
/// the crown and the width, so both are measured on the silhouette and carried along.
struct HeadShape {
  double shift = 0.0;        ///< of the head's middle to the right of the square's
  double half_width = 0.44;  ///< hair included
  double crown = 0.74;       ///< above the square's centre
  double chin = 0.57;        ///< below the square's centre; not measured, the neck hides it
};

/// The head's ellipse. `scale_x`, `scale_y`: from pixels of the detector's picture to working pixels.
HeadRegion head_region(const TrackedFace& face, const HeadShape& shape, double scale_x, double scale_y);

/// The shape moved by `rate` (0 to 1) towards what the silhouette (CV_8UC1, working pixels) shows around
/// `head`, the region that `shape` gave. Rows and columns where something else touches the head are left out.
HeadShape adapted(const HeadShape& shape, const HeadRegion& head, const cv::Mat& silhouette, double rate);

/// The shape around the square `to` of the head that `shape` had around the square `from`, within what heads
/// may have. Only the chin is where the new square says.
HeadShape carried(const HeadShape& shape, const TrackedFace& from, const TrackedFace& to);

/// The head of an upright person whose face is not seen (turned away, a mask, too small), from the outline
/// alone: the top of the largest piece of the silhouette, down to where it widens into shoulders. Working
/// pixels, not `detected`. Nothing when no such shape is there.
std::optional<HeadRegion> head_from_silhouette(const cv::Mat& silhouette);

/// Are there shoulders on both sides of the head, alike in width?
bool faces_camera(const HeadRegion& head, const cv::Mat& silhouette);

/// The detector's square that `shape` would have turned into `head`; inverse of head_region.
cv::Rect2d face_square(const HeadRegion& head, const HeadShape& shape, double scale_x, double scale_y);

}  // namespace telemime
