// SPDX-License-Identifier: Apache-2.0
#include "telemime/nets/hand_landmarks.h"

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "telemime/nets/models/table.h"

namespace telemime {
namespace {

constexpr int kCropperInput = 256;     // pixels
constexpr int kLandmarkerInput = 224;  // pixels
constexpr double kLeastPresence = 0.5;

enum Output : std::size_t { kLandmarks, kPresence, kHandedness, kWorld };

PictureRegion square_of(const Eigen::Vector2d& centre, double side, const Eigen::Vector2d& up) {
  return {.centre = centre,
          .width = side,
          .height = side,
          .angle = 0.5 * std::numbers::pi - std::atan2(-up.y(), up.x())};
}

// The squares are those of MediaPipe's graphs (hand_landmarks_from_pose_to_recrop_roi,
// hand_recrop_by_roi_cpu, hand_landmarks_to_roi), for which the networks were made: shifted before they are
// enlarged.
constexpr double kShift = 0.1;  // of what is enlarged, toward the fingers

// A generous square from three points of the pose: the hand lies beyond the wrist, about the knuckles.
PictureRegion rough_region(const PoseLandmarks& pose, HandSide side) {
  const bool left = side == HandSide::left;
  const auto pixel = [&](int left_index, int right_index) {
    return pose.points[left ? left_index : right_index].pixel;
  };
  const Eigen::Vector2d wrist = pixel(PoseLandmarkIndex::left_wrist, PoseLandmarkIndex::right_wrist);
  const Eigen::Vector2d index = pixel(PoseLandmarkIndex::left_index, PoseLandmarkIndex::right_index);
  const Eigen::Vector2d little = pixel(PoseLandmarkIndex::left_pinky, PoseLandmarkIndex::right_pinky);
  const Eigen::Vector2d knuckles = (2.0 * index + little) / 3.0;
  constexpr double kMargin = 2.7;
  const Eigen::Vector2d axis = knuckles - wrist;
  return square_of(knuckles + 2.0 * kShift * axis, 2.0 * kMargin * axis.norm(), axis);
}

}  // namespace

HandNetworks load_hand_networks(const std::filesystem::path& models) {
  const std::vector<std::string> outputs = {"Identity", "Identity_1", "Identity_2", "Identity_3"};
  return {.cropper = load_network(models, "hand_recrop"),
          .landmarker = load_network(models, "hand_landmark_full", {.inputs = {}, .outputs = outputs})};
}

std::optional<PictureRegion> hand_region(const cv::Mat& picture, const PoseLandmarks& pose, HandSide side,
                                         HandNetworks& networks) {
  constexpr double kSmallest = 8.0;  // pixels
  // The cropper gives the hand's middle and a point below it, at half a side's distance.
  const PictureRegion rough = rough_region(pose, side);
  if (!(rough.width >= kSmallest)) {
    return std::nullopt;
  }
  const InputFormat cropper_format{.size = {kCropperInput, kCropperInput}};
  const auto corners = networks.cropper.run(network_input(picture, rough, cropper_format))[0];
  const Eigen::Vector2d middle = rough.pixel(Eigen::Vector2d(corners[0], corners[1]) / kCropperInput);
  const Eigen::Vector2d below = rough.pixel(Eigen::Vector2d(corners[2], corners[3]) / kCropperInput);
  const Eigen::Vector2d axis = middle - below;
  const PictureRegion region = square_of(middle + 2.0 * kShift * axis, 2.0 * axis.norm(), axis);
  return region.width >= kSmallest ? std::optional(region) : std::nullopt;
}

PictureRegion next_region(const HandLandmarks& hand) {
  // The palm, thumb and middle joints, whose extent changes little when the hand closes.
  constexpr std::array<std::size_t, 12> kSteady = {0, 1, 2, 3, 5, 6, 9, 10, 13, 14, 17, 18};
  constexpr double kMargin = 2.0;
  const auto pixel = [&](std::size_t i) { return hand.points[i].pixel; };
  const Eigen::Vector2d up = 0.5 * pixel(10) + 0.25 * (pixel(6) + pixel(14)) - pixel(0);
  const Eigen::Vector2d axis =
      up.norm() > 0.0 ? Eigen::Vector2d(up.normalized()) : Eigen::Vector2d(0.0, -1.0);
  const Eigen::Vector2d across(-axis.y(), axis.x());
  Eigen::Array2d low = Eigen::Array2d::Constant(INFINITY);
  Eigen::Array2d high = -low;
  for (const std::size_t i : kSteady) {
    const Eigen::Array2d own(pixel(i).dot(axis), pixel(i).dot(across));
    low = low.min(own);
    high = high.max(own);
  }
  const Eigen::Array2d middle = 0.5 * (low + high);
  const Eigen::Array2d size = high - low;
  return square_of((middle[0] + kShift * size[0]) * axis + middle[1] * across, kMargin * size.maxCoeff(),
                   axis);
}

std::optional<HandLandmarks> hand_in(const cv::Mat& picture, const PictureRegion& region,
                                     HandNetworks& networks) {
  HandLandmarks hand;
  hand.region = region;

  const InputFormat format{.size = {kLandmarkerInput, kLandmarkerInput}};
  const auto outputs = networks.landmarker.run(network_input(picture, hand.region, format));
  hand.presence = outputs[kPresence][0];
  hand.is_right = outputs[kHandedness][0];
  if (!(hand.presence >= kLeastPresence)) {
    return std::nullopt;
  }
  for (std::size_t i = 0; i < HandLandmarks::kCount; ++i) {
    const float* const values = outputs[kLandmarks].data() + 3 * i;
    const float* const world = outputs[kWorld].data() + 3 * i;
    HandLandmark& point = hand.points[i];
    point.pixel = hand.region.pixel(Eigen::Vector2d(values[0], values[1]) / kLandmarkerInput);
    point.world.head<2>() = hand.region.rotation() * Eigen::Vector2d(world[0], world[1]);
    point.world.z() = world[2];
  }
  return hand;
}

std::optional<HandLandmarks> find_hand(const cv::Mat& picture, const PoseLandmarks& pose, HandSide side,
                                       HandNetworks& networks) {
  const auto region = hand_region(picture, pose, side, networks);
  return region ? hand_in(picture, *region, networks) : std::nullopt;
}

}  // namespace telemime
