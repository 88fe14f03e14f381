// SPDX-License-Identifier: Apache-2.0
// The parts of FeatureExtractor that concern the head: where the face is searched, and what a head is.
#include <algorithm>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "telemime/image/features.h"

namespace telemime {

std::optional<TrackedFace> FeatureExtractor::face_of(const std::optional<PoseLandmarks>& landmarks,
                                                     const WorkingImages& p) {
  std::optional<cv::Rect2d> square;
  if (landmarks) {
    square = face_square(scaled_to(*landmarks, p.grey.size(), p.face.size()));
  }
  return square ? head_.take_over(p.face, *square, elapsed_)
                : head_.update(p.face, face_search_area(p), skin_test(p), elapsed_);
}

std::optional<HeadRegion> FeatureExtractor::head_region_of(const std::optional<TrackedFace>& face,
                                                           const WorkingImages& p) const {
  if (!face) {
    return std::nullopt;
  }
  return head_region(*face, shape_, static_cast<double>(config_.width) / p.face.cols,
                     static_cast<double>(config_.height) / p.face.rows);
}

cv::Rect FeatureExtractor::face_search_area(const WorkingImages& p) const {
  const cv::Rect whole(0, 0, p.face.cols, p.face.rows);
  if (!background_complete_ || silhouette_.empty()) {
    return whole;
  }
  // With a complete background, a face can only be in or near the silhouette of the previous frame.
  const cv::Rect box = cv::boundingRect(silhouette_);
  if (box.empty()) {
    return {};
  }
  const double sx = static_cast<double>(p.face.cols) / config_.width;
  const double sy = static_cast<double>(p.face.rows) / config_.height;
  const int margin = p.face.cols / 16;
  return cv::Rect(static_cast<int>(box.x * sx) - margin, static_cast<int>(box.y * sy) - margin,
                  static_cast<int>(box.width * sx) + 2 * margin,
                  static_cast<int>(box.height * sy) + 2 * margin) &
         whole;
}

FaceTest FeatureExtractor::skin_test(const WorkingImages& p) const {
  const double sx = static_cast<double>(config_.width) / p.face.cols;
  const double sy = static_cast<double>(config_.height) / p.face.rows;
  return [sx, sy, &colour = p.colour](const cv::Rect& face) {
    constexpr double kLeastSkin = 0.2;
    return possible_skin(colour, cv::Rect(static_cast<int>(face.x * sx), static_cast<int>(face.y * sy),
                                          std::max(1, static_cast<int>(face.width * sx)),
                                          std::max(1, static_cast<int>(face.height * sy)))) > kLeastSkin;
  };
}

void FeatureExtractor::follow_head_outline(const WorkingImages& p, const cv::Mat& silhouette) {
  if (head_.confirmed()) {
    return;
  }
  if (const auto head = head_from_silhouette(silhouette)) {
    const double sx = static_cast<double>(config_.width) / p.face.cols;
    const double sy = static_cast<double>(config_.height) / p.face.rows;
    const cv::Rect2d square = face_square(*head, shape_, sx, sy);
    const auto& track = head_.current();
    const cv::Point2d centre(square.x + 0.5 * square.width, square.y + 0.5 * square.height);
    if (track && cv::norm(track->centre - centre) > 0.7 * track->side) {
      head_.reset();
    }
    head_.adopt(p.face, square, 0.5);
  }
}

bool FeatureExtractor::differs_from_background(const BackgroundEnergy& background,
                                               const HeadRegion& head) const {
  // The background model explains a face on a poster, but not the head of a person.
  constexpr float kBackgroundEnergy = -9.0F;
  int inside = 0;
  int explained = 0;
  for (int r = 0; r < background.energy.rows; ++r) {
    for (int c = 0; c < background.energy.cols; ++c) {
      const double x = (c - head.centre.x()) / head.radii.x();
      const double y = (r - head.centre.y()) / head.radii.y();
      if (x * x + y * y < 0.8) {
        ++inside;
        explained += background.energy.at<float>(r, c) < kBackgroundEnergy ? 1 : 0;
      }
    }
  }
  return inside > 0 && explained * 3 < inside * 2;
}

}  // namespace telemime
