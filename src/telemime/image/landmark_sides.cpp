// SPDX-License-Identifier: Apache-2.0
#include "telemime/image/landmark_sides.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace telemime {
namespace {

using Index = PoseLandmarkIndex;

constexpr double kFastestTurn = 10.0;  // rad/s: more than that of a dancer's pirouette
constexpr double kLongestHold = 0.5;   // s
constexpr double kSideView = 0.2;      // rad: a trunk nearer than this to a side view may face either way

// The points of the left side. That of the right follows each, except in the eyes, where three of a side do.
constexpr std::array<std::size_t, 16> kLeft{1, 2, 3, 7, 9, 11, 13, 15, 17, 19, 21, 23, 25, 27, 29, 31};

// The angle of TrunkFacing by how wide the shoulders look, across the trunk; empty for a trunk without
// length.
std::optional<double> facing_angle(const PoseLandmarks& landmarks) {
  constexpr double kWidthOverRegion =
      0.33 / (2.5 * 0.95);  // of an adult's shoulders; a region is 2.5 radii of 0.95 m
  const auto at = [&](int i) { return landmarks.points[static_cast<std::size_t>(i)].pixel; };
  const Eigen::Vector2d up =
      at(Index::left_shoulder) + at(Index::right_shoulder) - at(Index::left_hip) - at(Index::right_hip);
  const double width = kWidthOverRegion * landmarks.next_region.width;
  if (!(up.norm() > 0.0) || !(width > 0.0)) {
    return std::nullopt;
  }
  const Eigen::Vector2d across = Eigen::Vector2d(-up.y(), up.x()).normalized();
  const double seen = (at(Index::left_shoulder) - at(Index::right_shoulder)).dot(across) / width;
  return std::asin(std::clamp(seen, -1.0, 1.0));
}

}  // namespace

PoseLandmarks facing_other_way(PoseLandmarks landmarks) {
  for (const std::size_t left : kLeft) {
    std::swap(landmarks.points[left], landmarks.points[left + (left <= 3 ? 3 : 1)]);
  }
  for (PoseLandmark& point : landmarks.points) {
    point.depth = -point.depth;
    point.world.z() = -point.world.z();
  }
  return landmarks;
}

PoseLandmarks with_steady_sides(PoseLandmarks landmarks, double time, std::optional<TrunkFacing>& facing) {
  const std::optional<double> measured = facing_angle(landmarks);
  if (!measured) {
    return landmarks;
  }
  if (!facing || time <= facing->time) {
    // Who appears in front of a camera faces it, until the network has said otherwise for a while.
    const bool turned_away = *measured < -kSideView;
    facing = {.angle = turned_away ? -*measured : *measured,
              .time = time,
              .agreed = std::abs(*measured) > kSideView ? kLongestHold : 0.0};
    return turned_away ? facing_other_way(std::move(landmarks)) : landmarks;
  }
  // How far the trunk would have turned with the sides as given, and with them exchanged.
  const double elapsed = time - facing->time;
  const double turn = kFastestTurn * elapsed;
  const double given = std::abs(*measured - facing->angle);
  const double other = std::abs(-*measured - facing->angle);
  const bool contradicts = given > turn && other + turn < given;
  // A network that does not change its mind is believed in the end.
  const double agreed = std::min(kLongestHold, facing->agreed + (contradicts ? -elapsed : elapsed));
  if (contradicts && agreed <= 0.0) {
    facing = {.angle = *measured, .time = time, .agreed = *measured > 0.0 ? kLongestHold : elapsed};
    return landmarks;
  }
  const double now = contradicts ? -*measured : *measured;
  const double angle = facing->angle + std::clamp(now - facing->angle, -turn, turn);
  // Seen from the side, the person may turn either way.
  facing = {.angle = angle, .time = time, .agreed = std::abs(angle) > turn ? agreed : 0.0};
  return contradicts ? facing_other_way(std::move(landmarks)) : landmarks;
}

}  // namespace telemime
