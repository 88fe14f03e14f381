// SPDX-License-Identifier: Apache-2.0
#include "telemime/image/face_memory.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace telemime {
namespace {

constexpr int kColumns = 24;
constexpr int kRows = 36;
/// Extent of the grid in half widths and half heights of the head.
constexpr double kSide = 1.15;
constexpr double kUp = 1.05;
constexpr double kDown = 1.75;
/// Difference of l that is larger than those of a turn of the head or a change of shade.
constexpr float kChanged = 0.18F;
constexpr double kTimeToTrust = 3.0;  // 1/25 s
constexpr double kKept = 0.85;        // of the memory in 1/25 s

/// Transform from grid to image coordinates.
cv::Matx23d image_from_grid(const HeadRegion& head) {
  const double sx = 2 * kSide * head.radii.x() / kColumns;
  const double sy = (kUp + kDown) * head.radii.y() / kRows;
  return {sx, 0,  head.centre.x() - kSide * head.radii.x() + 0.5 * sx,
          0,  sy, head.centre.y() - kUp * head.radii.y() + 0.5 * sy};
}

/// The luminance on the grid.
cv::Mat sample_face(const LogColour& image, const HeadRegion& head) {
  cv::Mat out;
  cv::warpAffine(image.l, out, image_from_grid(head), cv::Size(kColumns, kRows),
                 cv::INTER_LINEAR | cv::WARP_INVERSE_MAP, cv::BORDER_REPLICATE);
  return out;
}

/// The bounding box of the grid in the image.
cv::Rect bounding_box(const HeadRegion& head, const cv::Size& size) {
  const cv::Rect box(cv::Point(static_cast<int>(std::floor(head.centre.x() - kSide * head.radii.x())),
                               static_cast<int>(std::floor(head.centre.y() - kUp * head.radii.y()))),
                     cv::Point(static_cast<int>(std::ceil(head.centre.x() + kSide * head.radii.x())) + 1,
                               static_cast<int>(std::ceil(head.centre.y() + kDown * head.radii.y())) + 1));
  return box & cv::Rect(cv::Point(0, 0), size);
}

}  // namespace

void label_hands_over_face(FaceMemory& memory, const LogColour& image, const HeadRegion& head,
                           const cv::Mat& skin, cv::Mat& labels, double elapsed) {
  const cv::Rect box = bounding_box(head, labels.size());
  if (box.width < 5 || box.height < 7) {
    return;
  }
  constexpr auto kArms = static_cast<unsigned char>(Label::arms);
  constexpr auto kHead = static_cast<unsigned char>(Label::head);
  const cv::Mat arms = labels(box) == kArms;
  const cv::Mat appearance = sample_face(image, head);
  // Update the memory if no arm is near the head; a few pixels beside the neck are no hand.
  if (cv::countNonZero(arms) * 25 < box.area()) {
    if (memory.appearance.empty()) {
      memory.appearance = appearance;
    } else {
      memory.appearance += (1.0 - std::pow(kKept, elapsed)) * (appearance - memory.appearance);
    }
    memory.seen += elapsed;
    return;
  }
  if (memory.seen < kTimeToTrust) {
    return;
  }
  // Difference from the memory, without the darkening of the whole face in the shadow of a hand.
  cv::Mat difference = appearance - memory.appearance;
  std::vector<float> values(difference.begin<float>(), difference.end<float>());
  difference = cv::abs(difference - std::clamp(median(values), -0.2F, 0.2F));
  cv::blur(difference, difference, cv::Size(3, 3));
  cv::Mat change;
  cv::warpAffine(difference, change, image_from_grid(head), labels.size(), cv::INTER_LINEAR,
                 cv::BORDER_CONSTANT, 0);
  cv::Mat changed = (change(box) > kChanged) & (labels(box) == kHead) & skin(box);
  // If most of the head differs, it turned away or the track drifted; that is not evidence of a hand.
  if (cv::countNonZero(changed) * 5 > cv::countNonZero(labels(box) == kHead) * 3) {
    return;
  }
  // Relabel the connected pieces that contain pixels of an arm.
  const int brush = std::max(3, static_cast<int>(0.25 * head.radii.x()) | 1);
  const cv::Mat disc = cv::getStructuringElement(cv::MORPH_ELLIPSE, cv::Size(brush, brush));
  cv::Mat hands = changed | arms;
  cv::morphologyEx(hands, hands, cv::MORPH_CLOSE, disc);
  cv::morphologyEx(hands, hands, cv::MORPH_OPEN, cv::getStructuringElement(cv::MORPH_RECT, cv::Size(3, 3)));
  cv::Mat pieces;
  const int count = cv::connectedComponents(hands, pieces, 8, CV_32S);
  for (int i = 1; i < count; ++i) {
    const cv::Mat piece = pieces == i;
    if (cv::countNonZero(piece & arms) > 0) {
      labels(box).setTo(kArms, piece & (labels(box) == kHead) & skin(box));
    }
  }
}

}  // namespace telemime
