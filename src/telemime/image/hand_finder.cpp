// SPDX-License-Identifier: Apache-2.0
#include "telemime/image/hand_finder.h"

#include <algorithm>
#include <utility>

#include "telemime/core/in_parallel.h"
#include "telemime/image/person_finder.h"

namespace telemime {
namespace {

const PoseLandmark& wrist_of(const PoseLandmarks& pose, HandSide side) {
  return pose.points[side == HandSide::left ? PoseLandmarkIndex::left_wrist : PoseLandmarkIndex::right_wrist];
}

double palm_of(const HandLandmarks& hand) {
  return (hand.points[9].pixel - hand.points[0].pixel).norm();
}

// How little a finding is that hand: far from its wrist, as a share of the region, and with the looks of the
// other.
double doubt(const HandLandmarks& hand, const PoseLandmarks& pose, HandSide side) {
  constexpr double kOtherHand = 0.2;
  const double away = (hand.points[0].pixel - wrist_of(pose, side).pixel).norm() / hand.region.width;
  return away + kOtherHand * (side == HandSide::right ? 1.0 - hand.is_right : hand.is_right);
}

}  // namespace

HandLandmarks scaled_to(HandLandmarks hand, cv::Size from, cv::Size to) {
  const Eigen::Vector2d scale(static_cast<double>(to.width) / from.width,
                              static_cast<double>(to.height) / from.height);
  const auto moved = [&](const Eigen::Vector2d& pixel) -> Eigen::Vector2d {
    return (pixel.array() + 0.5) * scale.array() - 0.5;
  };
  for (HandLandmark& p : hand.points) {
    p.pixel = moved(p.pixel);
  }
  hand.region.centre = moved(hand.region.centre);
  hand.region.width *= scale.x();
  hand.region.height *= scale.y();
  return hand;
}

bool are_same_hand(const HandLandmarks& a, const HandLandmarks& b) {
  constexpr double kNear = 0.5;  // of a palm, on average of the points
  double sum = 0.0;
  for (std::size_t i = 0; i < HandLandmarks::kCount; ++i) {
    sum += (a.points[i].pixel - b.points[i].pixel).norm() / HandLandmarks::kCount;
  }
  return sum < kNear * std::max(palm_of(a), palm_of(b));
}

HandFinder::HandFinder(const std::filesystem::path& models)
    : networks_{std::make_shared<HandNetworks>(load_hand_networks(models)),
                std::make_shared<HandNetworks>(load_hand_networks(models))} {}

bool HandFinder::is_followed(std::size_t hand, double time) const {
  constexpr double kRemembered = 0.25, kTurn = 0.6;  // s, where hands take turns
  const std::optional<Followed>& followed = followed_[hand];
  return followed && time > followed->time &&
         time - followed->time < (followed->missed ? kRemembered : kTurn);
}

std::optional<HandLandmarks> HandFinder::look_where_it_was(const cv::Mat& picture, std::size_t hand,
                                                           double time) {
  const std::optional<Seen> prepared = std::exchange(prepared_[hand], std::nullopt);
  return prepared && prepared->time == time
             ? prepared->hand
             : hand_in(picture, next_region(followed_[hand]->hand), *networks_[hand]);
}

void HandFinder::prepare(const cv::Mat& picture, double time, bool in_turn) {
  const auto prepare_for = [&](std::size_t i) {
    prepared_[i].reset();
    if (has_networks() && is_due(i, in_turn) && is_followed(i, time)) {
      prepared_[i] = {.time = time, .hand = look_where_it_was(picture, i, time)};
    }
  };
  in_parallel([&] { prepare_for(0); }, [&] { prepare_for(1); });
}

std::optional<HandLandmarks> HandFinder::look(const cv::Mat& picture, const PoseLandmarks& pose,
                                              HandSide side, double time) {
  constexpr double kAway = 0.6;  // of the region's width, between the wrist and that of the pose
  const PoseLandmark& wrist = wrist_of(pose, side);
  // Where it was, as long as the body has it there, too.
  const auto i = static_cast<std::size_t>(side);
  if (is_followed(i, time)) {
    auto hand = look_where_it_was(picture, i, time);
    if (hand && (hand->points[0].pixel - wrist.pixel).norm() < kAway * hand->region.width) {
      return hand;
    }
  }
  constexpr double kInPicture = 0.5;
  return wrist.presence > kInPicture ? find_hand(picture, pose, side, *networks_[i]) : std::nullopt;
}

std::array<SeenHand, 2> HandFinder::find(const cv::Mat& picture, const PoseLandmarks& pose, cv::Size working,
                                         double time, bool in_turn) {
  std::array<SeenHand, 2> hands;
  if (!has_networks()) {
    return hands;
  }
  const PoseLandmarks in_picture = scaled_to(pose, working, picture.size());
  const auto look_for = [&](HandSide side) {
    const auto i = static_cast<std::size_t>(side);
    if (is_due(i, in_turn)) {
      hands[i] = {.looked = true, .found = look(picture, in_picture, side, time)};
    }
  };
  in_parallel([&] { look_for(HandSide::left); }, [&] { look_for(HandSide::right); });
  turn_ = 1 - turn_;
  // Two findings of one hand: the better one stays.
  if (hands[0].found && hands[1].found && are_same_hand(*hands[0].found, *hands[1].found)) {
    const bool left = doubt(*hands[0].found, in_picture, HandSide::left) <
                      doubt(*hands[1].found, in_picture, HandSide::right);
    hands[left ? 1 : 0].found.reset();
    followed_[left ? 1 : 0].reset();
  }
  for (std::size_t i = 0; i < 2; ++i) {
    if (hands[i].looked && followed_[i]) {
      followed_[i]->missed = true;
    }
    if (hands[i].found) {
      followed_[i] = {.hand = *hands[i].found, .time = time};
      hands[i].found = scaled_to(std::move(*hands[i].found), picture.size(), working);
    }
  }
  return hands;
}

}  // namespace telemime
