// SPDX-License-Identifier: Apache-2.0
#include "telemime/image/person_finder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace telemime {
namespace {

using Index = PoseLandmarkIndex;

constexpr double kVisible = 0.5;

}  // namespace

PersonFinder::PersonFinder(const std::filesystem::path& models)
    : networks_(std::make_shared<PoseNetworks>(load_pose_networks(models, PoseModel::full, true))) {}

std::optional<PoseLandmarks> PersonFinder::find(const cv::Mat& picture) {
  if (!networks_) {
    return std::nullopt;
  }
  std::optional<PoseLandmarks> found = find_pose(picture, *networks_, region_);
  region_ = found ? std::optional(found->next_region) : std::nullopt;
  return found;
}

PoseLandmarks scaled_to(PoseLandmarks landmarks, cv::Size from, cv::Size to) {
  const Eigen::Vector2d scale(static_cast<double>(to.width) / from.width,
                              static_cast<double>(to.height) / from.height);
  const auto moved = [&](const Eigen::Vector2d& pixel) -> Eigen::Vector2d {
    return (pixel.array() + 0.5) * scale.array() - 0.5;
  };
  for (PoseLandmark& p : landmarks.points) {
    p.pixel = moved(p.pixel);
    p.covariance = scale.asDiagonal() * p.covariance * scale.asDiagonal();
    p.depth *= scale.x();
  }
  for (PictureRegion* region : {&landmarks.region, &landmarks.next_region}) {
    region->centre = moved(region->centre);
    region->width *= scale.x();
    region->height *= scale.y();
  }
  if (!landmarks.mask.empty()) {
    cv::resize(landmarks.mask, landmarks.mask, to, 0.0, 0.0, cv::INTER_AREA);
  }
  return landmarks;
}

std::optional<cv::Rect2d> face_square(const PoseLandmarks& landmarks) {
  const auto at = [&](int i) -> const PoseLandmark& { return landmarks.points[static_cast<std::size_t>(i)]; };
  const auto middle = [&](int a, int b) -> Eigen::Vector2d { return 0.5 * (at(a).pixel + at(b).pixel); };
  if (at(Index::nose).presence < kVisible || at(Index::nose).visibility < kVisible) {
    return std::nullopt;
  }
  // Pixels a metre, from whichever distance of an average adult's face is the least foreshortened.
  constexpr double kEyesToMouth = 0.066;
  constexpr double kBetweenEyes = 0.088;  // outer part of the eyes, as the network is taught
  constexpr double kBetweenEars = 0.150;
  const Eigen::Vector2d eyes = middle(Index::left_eye, Index::right_eye);
  const Eigen::Vector2d mouth = middle(Index::mouth_left, Index::mouth_right);
  const auto between = [&](int a, int b) { return (at(a).pixel - at(b).pixel).norm(); };
  const double per_metre = std::max({(mouth - eyes).norm() / kEyesToMouth,
                                     between(Index::left_eye, Index::right_eye) / kBetweenEyes,
                                     between(Index::left_ear, Index::right_ear) / kBetweenEars});
  // The detector's square is about 18 cm wide; its centre is a little below the eyes, between the ears.
  constexpr double kSide = 0.183;
  constexpr double kBelowEyes = 0.15;  // of the way to the mouth
  const Eigen::Vector2d front = eyes + kBelowEyes * (mouth - eyes);
  const Eigen::Vector2d ears = middle(Index::left_ear, Index::right_ear);
  const double centre_x = 0.5 * (front.x() + ears.x());
  const double side = kSide * per_metre;
  return cv::Rect2d(centre_x - 0.5 * (side - 1), front.y() - 0.5 * (side - 1), side, side);
}

cv::Mat mask_energy(const cv::Mat& mask, float most) {
  std::array<float, 256> table{};
  for (int i = 0; i < 256; ++i) {
    const float odds = (static_cast<float>(i) + 1.0F) / (256.0F - static_cast<float>(i));
    table[static_cast<std::size_t>(i)] = std::clamp(2.0F * std::log(odds), -most, most);
  }
  cv::Mat out(mask.size(), CV_32FC1);
  for (int r = 0; r < mask.rows; ++r) {
    const auto* in = mask.ptr<unsigned char>(r);
    auto* energy = out.ptr<float>(r);
    for (int c = 0; c < mask.cols; ++c) {
      energy[c] = table[in[c]];
    }
  }
  return out;
}

}  // namespace telemime
