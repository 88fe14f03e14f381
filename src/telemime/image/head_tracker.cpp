// SPDX-License-Identifier: Apache-2.0
#include "telemime/image/head_tracker.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace telemime {
namespace {

/// Side of the face image for the correlation in pixels; largest motion between frames in sides of the face.
constexpr int kPatch = 20;
constexpr double kReach = 0.5;
/// Shares of the old place, moved along with the face, and of the old size that stay in 1/25 s where a
/// network finds the face in every image.
constexpr double kKeptPlace = 0.5;
constexpr double kKeptSide = 0.75;

cv::Point2d centre_of(const cv::Rect2d& square) {
  return {square.x + 0.5 * (square.width - 1), square.y + 0.5 * (square.height - 1)};
}

/// The square of side `side` around `centre`, resampled to `size` x `size` pixels.
cv::Mat square_at(const cv::Mat& grey, const cv::Point2d& centre, double side, int size) {
  const double scale = side / size;
  const cv::Matx23d map(scale, 0, centre.x - 0.5 * side + 0.5 * scale, 0, scale,
                        centre.y - 0.5 * side + 0.5 * scale);
  cv::Mat out;
  cv::warpAffine(grey, out, map, cv::Size(size, size), cv::INTER_LINEAR | cv::WARP_INVERSE_MAP,
                 cv::BORDER_REPLICATE);
  return out;
}

/// Offset of the vertex of the parabola through three values, in [-0.5, 0.5].
double peak(double left, double middle, double right) {
  const double curvature = left - 2 * middle + right;
  return curvature < -1e-9 ? std::clamp(0.5 * (left - right) / curvature, -0.5, 0.5) : 0.0;
}

}  // namespace

HeadTracker::HeadTracker(const HeadTrackerConfig& config, const std::filesystem::path& cascades)
    : config_(config), detector_(cascades) {}

void HeadTracker::set_detection(const cv::Mat& grey, const cv::Rect2d& found, bool fresh) {
  const cv::Point2d centre = centre_of(found);
  const double side = found.width;
  if (!detected_before_ && face_) {
    replaced_ = face_;
    if (face_->match < config_.lost_match) {
      // Tracking failed in this image: only the size of the old square is known.
      replaced_->centre = centre;
    }
  }
  if (fresh || !detected_before_ || !face_) {
    face_ = TrackedFace{centre, side, true, 1.0};
  } else {
    // The detected square jitters by several percent: smooth its size more than its position.
    face_->side += 0.25 * (side - face_->side);
    face_->centre += 0.5 * (centre - face_->centre);
  }
  confirm(grey);
}

void HeadTracker::confirm(const cv::Mat& grey) {
  face_->detected = true;
  face_->match = 1.0;
  face_image_ = square_at(grey, face_->centre, face_->side, kPatch);
  detected_before_ = true;
  since_detected_ = 0.0;
  since_sure_ = 0.0;
}

double HeadTracker::track(const cv::Mat& grey) {
  const double window = face_->side * (1 + 2 * kReach);
  const int size = static_cast<int>(kPatch * (1 + 2 * kReach));
  const cv::Mat around = square_at(grey, face_->centre, window, size);
  // The best match, with sub-pixel precision by a parabola.
  cv::Mat score;
  cv::matchTemplate(around, face_image_, score, cv::TM_CCOEFF_NORMED);
  double best = 0;
  cv::Point at;
  cv::minMaxLoc(score, nullptr, &best, nullptr, &at);
  const auto value = [&](int x, int y) {
    return static_cast<double>(
        score.at<float>(std::clamp(y, 0, score.rows - 1), std::clamp(x, 0, score.cols - 1)));
  };
  const double dx = at.x + peak(value(at.x - 1, at.y), best, value(at.x + 1, at.y)) - 0.5 * (score.cols - 1);
  const double dy = at.y + peak(value(at.x, at.y - 1), best, value(at.x, at.y + 1)) - 0.5 * (score.rows - 1);
  if (best >= config_.lost_match) {
    face_->centre += cv::Point2d(dx, dy) * (face_->side / kPatch);
  }
  return best;
}

void HeadTracker::adopt(const cv::Mat& grey, const cv::Rect2d& square, double blend) {
  const cv::Point2d centre = centre_of(square);
  if (!face_) {
    face_ = TrackedFace{centre, square.width, false, 1.0};
    misses_ = 1;
    detected_before_ = false;
  } else {
    face_->centre += blend * (centre - face_->centre);
    face_->side += 0.3 * blend * (square.width - face_->side);
  }
  face_image_ = square_at(grey, face_->centre, face_->side, kPatch);
  since_sure_ = 0.0;
}

std::optional<TrackedFace> HeadTracker::take_over(const cv::Mat& grey, const cv::Rect2d& square,
                                                  double elapsed) {
  replaced_.reset();
  misses_ = 0;
  const cv::Point2d centre = centre_of(square);
  if (detected_before_ && face_ && cv::norm(centre - face_->centre) < kReach * face_->side) {
    // The correlation says how the face has moved, the network where it is: neither lag nor jitter.
    const double kept = track(grey) >= config_.lost_match ? std::pow(kKeptPlace, elapsed) : 0.0;
    face_->centre += (1.0 - kept) * (centre - face_->centre);
    face_->side += (1.0 - std::pow(kKeptSide, elapsed)) * (square.width - face_->side);
    confirm(grey);
  } else {
    set_detection(grey, square, true);
  }
  return face_;
}

std::optional<TrackedFace> HeadTracker::detect(const cv::Mat& grey, const cv::Rect& search,
                                               const FaceTest& is_face) {
  const int smallest = std::max(20, static_cast<int>(config_.smallest_face * grey.rows));
  const auto found = detector_.find(grey, search, smallest, grey.rows, is_face);
  since_search_ = 0.0;
  misses_ = 0;
  face_.reset();
  replaced_.reset();
  if (found) {
    set_detection(grey, *found, true);
  }
  return face_;
}

std::optional<TrackedFace> HeadTracker::update(const cv::Mat& grey, const cv::Rect& search,
                                               const FaceTest& is_face, double elapsed) {
  replaced_.reset();
  if (!face_) {
    since_search_ += elapsed;
    return since_search_ >= config_.search_every ? detect(grey, search, is_face) : std::nullopt;
  }
  // Track by correlation.
  face_->detected = false;
  face_->match = track(grey);
  since_detected_ += elapsed;
  const bool doubtful = face_->match < config_.lost_match + 0.2;
  since_sure_ = face_->match < config_.lost_match ? since_sure_ + elapsed : 0.0;
  // Detect near the tracked face at intervals, or if the correlation is low.
  if (doubtful || since_detected_ >= config_.detect_every) {
    // Enlarge the search after failed detections: the track may have drifted or have the wrong size.
    const double growth = 1.0 + 0.25 * std::min(misses_, 4);
    const double reach = face_->side * (doubtful ? 1.1 : 0.8) * growth;
    const cv::Rect window(
        cv::Point(static_cast<int>(face_->centre.x - reach), static_cast<int>(face_->centre.y - reach)),
        cv::Point(static_cast<int>(face_->centre.x + reach), static_cast<int>(face_->centre.y + reach)));
    const auto found = detector_.find(grey, window, static_cast<int>(face_->side * 0.75 / growth),
                                      static_cast<int>(face_->side * 1.3 * growth), is_face);
    since_detected_ = 0.0;
    if (found) {
      set_detection(grey, *found, misses_ >= 2);
      misses_ = 0;
    } else {
      ++misses_;
    }
  }
  // Search again if the position has been unreliable for too long.
  if (since_sure_ > config_.lost_after) {
    return detect(grey, search, is_face);
  }
  return face_;
}

}  // namespace telemime
