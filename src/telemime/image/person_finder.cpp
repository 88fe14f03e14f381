// SPDX-License-Identifier: Apache-2.0
#include "telemime/image/person_finder.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <opencv2/imgproc.hpp>
#include <utility>

namespace telemime {
namespace {

using Index = PoseLandmarkIndex;

constexpr double kVisible = 0.5;
constexpr double kBodyRadius = 0.95;  // m, PersonPlace::size

}  // namespace

PersonFinder::PersonFinder(const std::filesystem::path& models)
    : networks_(std::make_shared<PoseNetworks>(load_pose_networks(models))) {}

PersonPlace place_of(const PoseLandmarks& landmarks) {
  constexpr double kWidthOverRadius = 2.5;  // of a region: region_of_axis()
  return {.shoulders = 0.5 * (landmarks.points[Index::left_shoulder].pixel +
                              landmarks.points[Index::right_shoulder].pixel),
          .size = landmarks.next_region.width / kWidthOverRadius};
}

PersonPlace place_of(const Detection& person) {
  return {.shoulders = person.keypoints[2], .size = (person.keypoints[1] - person.keypoints[0]).norm()};
}

bool may_be_same(const PersonPlace& before, const PersonPlace& now, double seconds, double error) {
  constexpr double kSpeed = 2.5;     // m/s, across
  constexpr double kApproach = 1.0;  // 1/s: how fast the size grows, as a logarithm
  constexpr double kSizeError = 0.3;
  const double per_metre = std::max(before.size, now.size) / kBodyRadius;
  return (now.shoulders - before.shoulders).norm() < (error + kSpeed * seconds) * per_metre &&
         std::abs(std::log(now.size / before.size)) < kSizeError + kApproach * seconds;
}

std::vector<std::size_t> order_of_search(std::span<const PersonPlace> places,
                                         const std::optional<PersonPlace>& followed, cv::Size picture) {
  const auto cost = [&](const PersonPlace& place) {
    if (followed) {
      return (place.shoulders - followed->shoulders).norm() / followed->size +
             std::abs(std::log(place.size / followed->size));
    }
    const double aside = 2.0 * place.shoulders.x() / picture.width - 1.0;
    return aside * aside - std::log(place.size);
  };
  std::vector<std::size_t> order(places.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return cost(places[a]) < cost(places[b]); });
  return order;
}

bool PersonFinder::is_followed(const PoseLandmarks& landmarks, double time) const {
  constexpr double kError = 0.15;
  return !followed_ || may_be_same(followed_->place, place_of(landmarks), time - followed_->time, kError);
}

std::optional<SeenPerson> PersonFinder::detected(const cv::Mat& picture, double time) {
  constexpr double kError = 0.3;
  const std::vector<Detection> people = detect_poses(picture, networks_->detector);
  std::vector<PersonPlace> places;
  places.reserve(people.size());
  for (const Detection& person : people) {
    places.push_back(place_of(person));
  }
  const std::optional<PersonPlace> before = followed_ ? std::optional(followed_->place) : std::nullopt;
  for (const std::size_t i : order_of_search(places, before, picture.size())) {
    if (before && !may_be_same(*before, places[i], time - followed_->time, kError)) {
      continue;
    }
    auto found = find_landmarks(picture, region_of_person(people[i]), networks_->landmarker);
    if (found && is_followed(found->landmarks, time)) {
      return found;
    }
  }
  return std::nullopt;
}

std::optional<PoseLandmarks> PersonFinder::find(const cv::Mat& picture, double time) {
  constexpr double kRemembered = 1.0;  // s: after that, anybody may be the person
  constexpr double kError = 0.15;      // m, of a place
  found_ = switched_ = false;
  if (!networks_) {
    return std::nullopt;
  }
  if (followed_ && (time < followed_->time || time - followed_->time > kRemembered)) {
    followed_.reset();
  }
  // Where the person was; otherwise wherever the detector sees somebody who may be them.
  std::optional<SeenPerson> found;
  cv::Mat mask;
  double mask_time = time;
  if (followed_) {
    found = find_landmarks(picture, followed_->region, networks_->landmarker);
    if (found && !is_followed(found->landmarks, time)) {
      found.reset();
    }
    if (found) {
      mask = followed_->mask;
      mask_time = followed_->mask_time;
    }
  }
  const bool moved_on = !found.has_value();
  if (!found) {
    found = detected(picture, time);
  }
  found_ = found.has_value();
  if (!found) {
    return std::nullopt;
  }
  std::optional<TrunkFacing> facing = followed_ ? followed_->facing : std::nullopt;
  PoseLandmarks landmarks = with_steady_sides(std::move(found->landmarks), time, facing);
  followed_ = {.region = landmarks.next_region,
               .place = place_of(landmarks),
               .time = time,
               .picture = picture.size(),
               .mask_input = std::move(found->mask),
               .mask = mask,
               .mask_time = mask_time,
               .own_mask = false,
               .facing = facing};
  // Whoever is found where the person nearby was not may be the one who was followed before.
  const PersonPlace place = followed_->place;
  switched_ = went_over_ && moved_on && last_ && !may_be_same(*last_, place, 0.0, kError);
  last_ = place;
  if (count(picture, place, time)) {
    // Somebody sits in front of the person who is followed: from now on, they are the person.
    reset();
    auto nearer = find(picture, time);
    went_over_ = switched_ = nearer && !may_be_same(place, place_of(*nearer), 0.0, kError);
    return nearer;
  }
  return landmarks;
}

cv::Mat PersonFinder::mask(bool keep) {
  constexpr double kMaskAge = 0.045;  // s: every second picture at 25 or 30 a second
  if (!found_) {
    return {};
  }
  Followed& person = *followed_;
  const bool is_kept =
      keep && person.mask.size() == person.picture && person.time - person.mask_time <= kMaskAge;
  if (!person.own_mask && !is_kept) {
    person.mask = person_mask(person.mask_input, person.picture, networks_->mask);
    person.mask_time = person.time;
    person.own_mask = true;
  }
  return person.mask;
}

bool PersonFinder::count(const cv::Mat& picture, const PersonPlace& person, double time) {
  constexpr double kEvery = 1.0;  // s
  if (counted_ && time >= *counted_ && time < *counted_ + kEvery) {
    return false;
  }
  counted_ = time;
  people_ = 1;
  bool much_nearer = false;
  constexpr double kSmallest = 0.4;    // of the size of the person: whoever is farther away is no matter
  constexpr double kApart = 0.35;      // m
  constexpr double kMuchNearer = 2.0;  // times the size: the user of a desk before somebody at the next one
  constexpr double kStays = 2.0;       // s: longer than somebody walks past
  for (const Detection& other : detect_poses(picture, networks_->detector)) {
    const PersonPlace place = place_of(other);
    const double apart = (place.shoulders - person.shoulders).norm() / person.size * kBodyRadius;
    if (place.size > kSmallest * person.size && apart > kApart &&
        find_landmarks(picture, region_of_person(other), networks_->landmarker)) {
      ++people_;
      much_nearer = much_nearer || place.size > kMuchNearer * person.size;
    }
  }
  if (!much_nearer) {
    nearer_since_.reset();
  } else if (!nearer_since_) {
    nearer_since_ = time;
  }
  return nearer_since_ && time - *nearer_since_ >= kStays;
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
  landmarks.mask.release();
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
  cv::Mat table(1, 256, CV_32FC1);
  for (int i = 0; i < 256; ++i) {
    const float odds = (static_cast<float>(i) + 1.0F) / (256.0F - static_cast<float>(i));
    table.at<float>(i) = std::clamp(2.0F * std::log(odds), -most, most);
  }
  cv::Mat out;
  cv::LUT(mask, table, out);
  return out;
}

}  // namespace telemime
