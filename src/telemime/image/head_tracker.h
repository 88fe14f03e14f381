// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>

#include "telemime/image/face.h"

namespace telemime {

/// The tracked face square, in pixels of the image given to the tracker.
struct TrackedFace {
  cv::Point2d centre;
  double side = 0.0;
  bool detected = false;  ///< by the face detector in this frame
  double match = 1.0;     ///< correlation with the face image of the last update, [-1, 1]
};

/// The table of settings (settings_of(ImageConfig&)) gives the meaning, unit and range of each.
struct HeadTrackerConfig {
  int detect_every = 5;
  int search_every = 3;
  double lost_match = 0.45;
  int lost_after = 12;
  double smallest_face = 0.07;
};

/// Tracks one face: by a face detector at intervals, by correlation of the face image in between.
class HeadTracker {
 public:
  /// `cascades`: folder of OpenCV's face cascades, see find_cascade. Throws Error(config) if they are
  /// missing.
  HeadTracker(const HeadTrackerConfig& config, const std::filesystem::path& cascades);

  /// The face in the next image (CV_8UC1; all images have the same size); empty if there is none. A face that
  /// is not tracked yet is searched in `search` only. `elapsed`: 1/25 s since the last image.
  std::optional<TrackedFace> update(const cv::Mat& grey, const cv::Rect& search, const FaceTest& is_face,
                                    double elapsed = 1.0);

  /// Resets the track and detects the largest face in `search` that satisfies `is_face`.
  std::optional<TrackedFace> detect(const cv::Mat& grey, const cv::Rect& search, const FaceTest& is_face);

  /// Moves the track by the share `blend` (0 to 1) towards a face square found by other means (the outline of
  /// the head), or starts a track there.
  void adopt(const cv::Mat& grey, const cv::Rect2d& square, double blend);

  /// Follows the face by correlation and corrects place and size by the square that a network has found in
  /// this image; a face elsewhere replaces the track. `elapsed`: 1/25 s since the last image.
  std::optional<TrackedFace> take_over(const cv::Mat& grey, const cv::Rect2d& square, double elapsed = 1.0);

  /// The tracked face after the last call.
  const std::optional<TrackedFace>& current() const { return face_; }

  /// Whether the face was detected in the last detection, or earlier and the correlation has been good since.
  bool confirmed() const {
    return face_.has_value() && (misses_ == 0 || (detected_before_ && face_->match >= config_.lost_match));
  }

  /// If the last update detected, for the first time, the face of a track that started from the outline: the
  /// square of that track in the current image, which the detected square replaced.
  const std::optional<TrackedFace>& replaced() const { return replaced_; }

  /// Drops the track.
  void reset() { face_.reset(); }

  /// Drops the track; the next update searches.
  void restart() {
    reset();
    since_search_ = config_.search_every;
  }

 private:
  void set_detection(const cv::Mat& grey, const cv::Rect2d& found, bool fresh);
  void confirm(const cv::Mat& grey);
  double track(const cv::Mat& grey);

  HeadTrackerConfig config_;
  FaceDetector detector_;
  std::optional<TrackedFace> face_;
  std::optional<TrackedFace> replaced_;
  cv::Mat face_image_;
  bool detected_before_ = false;  ///< the face of this track was detected at least once
  double since_detected_ = 0.0;   ///< this and the times below in 1/25 s
  int misses_ = 0;                ///< consecutive detections without a result
  double since_sure_ = 0.0;
  double since_search_ = 1e6;
};

}  // namespace telemime
