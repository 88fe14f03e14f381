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
/// Of half the head's height or width: the part of the picture that the grid covers.
constexpr double kAside = 1.15;
constexpr double kUp = 1.05;
constexpr double kDown = 1.75;
/// Difference of l that is not a turn of the head or a change of shade.
constexpr float kChanged = 0.18F;
constexpr int kFramesToTrust = 3;

/// Grid to picture.
cv::Matx23d map_of(const HeadRegion& head) {
  const double sx = 2 * kAside * head.radii.x() / kColumns;
  const double sy = (kUp + kDown) * head.radii.y() / kRows;
  return {sx, 0,  head.centre.x() - kAside * head.radii.x() + 0.5 * sx,
          0,  sy, head.centre.y() - kUp * head.radii.y() + 0.5 * sy};
}

cv::Mat look_of(const LogColour& picture, const HeadRegion& head) {
  cv::Mat out;
  cv::warpAffine(picture.l, out, map_of(head), cv::Size(kColumns, kRows),
                 cv::INTER_LINEAR | cv::WARP_INVERSE_MAP, cv::BORDER_REPLICATE);
  return out;
}

cv::Rect box_of(const HeadRegion& head, const cv::Size& size) {
  const cv::Rect box(cv::Point(static_cast<int>(std::floor(head.centre.x() - kAside * head.radii.x())),
                               static_cast<int>(std::floor(head.centre.y() - kUp * head.radii.y()))),
                     cv::Point(static_cast<int>(std::ceil(head.centre.x() + kAside * head.radii.x())) + 1,
                               static_cast<int>(std::ceil(head.centre.y() + kDown * head.radii.y())) + 1));
  return box & cv::Rect(cv::Point(0, 0), size);
}

}  // namespace

void uncover_hands(FaceMemory& memory, const LogColour& picture, const HeadRegion& head, const cv::Mat& skin,
                   cv::Mat& labels) {
  const cv::Rect box = box_of(head, labels.size());
  if (box.width < 5 || box.height < 7) {
    return;
  }
  constexpr auto kArms = static_cast<unsigned char>(Label::arms);
  constexpr auto kHead = static_cast<unsigned char>(Label::head);
  const cv::Mat arms = labels(box) == kArms;
  const cv::Mat look = look_of(picture, head);
  // A sliver beside the neck is no hand.
  if (cv::countNonZero(arms) * 25 < box.area()) {
    if (memory.look.empty()) {
      memory.look = look;
    } else {
      memory.look += 0.15 * (look - memory.look);
    }
    ++memory.frames;
    return;
  }
  if (memory.frames < kFramesToTrust) {
    return;
  }
  // A hand shades the face: what all of it has become darker by is not a change.
  cv::Mat difference = look - memory.look;
  std::vector<float> values(difference.begin<float>(), difference.end<float>());
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  difference = cv::abs(difference - std::clamp(*middle, -0.2F, 0.2F));
  cv::blur(difference, difference, cv::Size(3, 3));
  cv::Mat wide;
  cv::warpAffine(difference, wide, map_of(head), labels.size(), cv::INTER_LINEAR, cv::BORDER_CONSTANT, 0);
  cv::Mat changed = (wide(box) > kChanged) & (labels(box) == kHead) & skin(box);
  // When nearly all of it is new the head turned away, or the track slid: no ground to accuse a hand.
  if (cv::countNonZero(changed) * 5 > cv::countNonZero(labels(box) == kHead) * 3) {
    return;
  }
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
