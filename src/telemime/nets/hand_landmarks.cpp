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
  constexpr double kShift = 0.1;  // of the side, away from the wrist
  const Eigen::Vector2d axis = knuckles - wrist;
  const double side_length = 2.0 * axis.norm() * kMargin;
  PictureRegion region{.centre = knuckles,
                       .width = side_length,
                       .height = side_length,
                       .angle = 0.5 * std::numbers::pi - std::atan2(-axis.y(), axis.x())};
  region.centre = region.pixel({0.5, 0.5 - kShift});
  return region;
}

}  // namespace

HandNetworks load_hand_networks(const std::filesystem::path& models, HandModel model) {
  const std::vector<std::string> outputs = {"Identity", "Identity_1", "Identity_2", "Identity_3"};
  return {.cropper = load_network(models, "hand_recrop"),
          .landmarker = load_network(
              models, model == HandModel::lite ? "hand_landmark_lite" : "hand_landmark_full", outputs)};
}

std::optional<HandLandmarks> find_hand(const cv::Mat& picture, const PoseLandmarks& pose, HandSide side,
                                       HandNetworks& networks) {
  // The cropper gives the hand's middle and a point below it, at half a side's distance.
  const PictureRegion rough = rough_region(pose, side);
  const InputFormat cropper_format{.size = {kCropperInput, kCropperInput}};
  const auto corners = networks.cropper.run(network_input(picture, rough, cropper_format))[0];
  const Eigen::Vector2d middle = rough.pixel(Eigen::Vector2d(corners[0], corners[1]) / kCropperInput);
  const Eigen::Vector2d below = rough.pixel(Eigen::Vector2d(corners[2], corners[3]) / kCropperInput);
  const Eigen::Vector2d up = middle - below;
  const double length = 2.0 * up.norm();
  HandLandmarks hand;
  hand.region = {.centre = middle,
                 .width = length,
                 .height = length,
                 .angle = 0.5 * std::numbers::pi - std::atan2(-up.y(), up.x())};

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
    point.depth = values[2] / kLandmarkerInput * hand.region.width;
    point.world.head<2>() = hand.region.rotation() * Eigen::Vector2d(world[0], world[1]);
    point.world.z() = world[2];
  }
  return hand;
}

}  // namespace telemime
