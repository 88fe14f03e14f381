// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>

#include "telemime/image/face.h"

namespace telemime {

/// A head as the tracker carries it: the face square of the detector, pixels of the picture given to it.
struct TrackedFace {
  cv::Point2d centre;
  double side = 0.0;
  bool detected = false;  ///< the detector fired in this frame
  double match = 1.0;     ///< correlation with the face when last detected, [-1, 1]
};

struct HeadTrackerConfig {
  int detect_every = 5;         ///< frames between looks of the detector while the track is good
  int search_every = 3;         ///< frames between searches of the whole picture while there is no track
  double lost_match = 0.45;     ///< below this correlation the face is not where it was
  int lost_after = 12;          ///< frames without a sure position until the track is given up
  double smallest_face = 0.07;  ///< of the picture's height
};

/// Follows one face: the detector anchors it, a correlation of the face's picture carries it in between.
class HeadTracker {
 public:
  HeadTracker(const HeadTrackerConfig& config, const std::filesystem::path& cascades);

  /// The face in the next picture (CV_8UC1; all pictures of one size), or nothing. Without a track it is
  /// sought in `search` only.
  std::optional<TrackedFace> update(const cv::Mat& grey, const cv::Rect& search, const FaceTest& is_face);

  /// Searches `search`, for faces that pass the test, at once and starts anew from what is found.
  std::optional<TrackedFace> restart(const cv::Mat& grey, const cv::Rect& search, const FaceTest& is_face);

  /// Takes over a face square that was found by other means (the outline), and follows that. With `blend`
  /// below 1 a track that exists moves only so far towards it.
  void adopt(const cv::Mat& grey, const cv::Rect2d& square, double blend);

  /// The track, as of the last call.
  const std::optional<TrackedFace>& current() const { return face_; }

  /// The detector has seen this face, at its last look or earlier with a good correlation since.
  bool confirmed() const {
    return face_.has_value() && (misses_ == 0 || (anchored_ && face_->match >= config_.lost_match));
  }

  /// The square of a track that the outline began, carried into this picture, when the detector saw its face
  /// there for the first time and its square was taken instead.
  const std::optional<TrackedFace>& replaced() const { return replaced_; }

  /// Forgets the track.
  void forget() { face_.reset(); }

 private:
  void anchor(const cv::Mat& grey, const cv::Rect& found, bool fresh);
  double carry(const cv::Mat& grey);

  HeadTrackerConfig config_;
  FaceDetector detector_;
  std::optional<TrackedFace> face_;
  std::optional<TrackedFace> replaced_;
  cv::Mat patch_;
  bool anchored_ = false;  ///< the detector has fired on this track
  int since_detected_ = 0;
  int misses_ = 0;  ///< looks of the detector in a row that found nothing
  int since_sure_ = 0;
  int since_search_ = 1 << 20;
};

}  // namespace telemime
