// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>

#include "telemime/image/frame_features.h"
#include "telemime/image/head_tracker.h"

namespace telemime {

/// The head of a person relative to the square of the face detector, in sides of that square. Crown and width
/// depend on the hair, so they are measured on the silhouette.
struct HeadShape {
  double shift = 0.0;  ///< from the centre of the square to the middle of the head, positive to the right
  double half_width = 0.44;  ///< including hair
  double crown = 0.74;       ///< above the square's centre
  double chin = 0.57;        ///< below the square's centre; not measured: the neck hides it in the silhouette
};

/// The ellipse of the head in working pixels. `scale_x` and `scale_y` convert pixels of the detector's image
/// to working pixels.
HeadRegion head_region(const TrackedFace& face, const HeadShape& shape, double scale_x, double scale_y);

/// `shape` moved by `rate` (0 to 1) towards the outline of the silhouette (CV_8UC1, working size) around
/// `head`, the region of `shape`. Rows and columns in which something else touches the head are ignored.
HeadShape adapted(const HeadShape& shape, const HeadRegion& head, const cv::Mat& silhouette, double rate);

/// The shape, relative to the square `to`, of the head that has `shape` relative to the square `from`,
/// limited to the range of human heads. The chin is not converted: it keeps its distance in sides of the
/// square.
HeadShape rebased(const HeadShape& shape, const TrackedFace& from, const TrackedFace& to);

/// The head of an upright person whose face cannot be detected (turned away, masked or too small): the top of
/// the largest component of the silhouette, down to where it widens to the shoulders. In working pixels, not
/// `detected`. Empty if there is no such shape.
std::optional<HeadRegion> head_from_silhouette(const cv::Mat& silhouette);

/// Whether there are shoulders of similar width on both sides of the head.
bool faces_camera(const HeadRegion& head, const cv::Mat& silhouette);

/// The square of the face detector for which head_region gives `head`; the inverse of head_region.
cv::Rect2d face_square(const HeadRegion& head, const HeadShape& shape, double scale_x, double scale_y);

}  // namespace telemime
