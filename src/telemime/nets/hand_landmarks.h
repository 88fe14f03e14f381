// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <opencv2/core.hpp>
#include <optional>

#include "telemime/nets/network.h"
#include "telemime/nets/picture_region.h"
#include "telemime/nets/pose_landmarks.h"

namespace telemime {

/// The person's own left or right hand.
enum class HandSide { left, right };

/// A point of a hand: 0 is the wrist, then four points each from the base to the tip of thumb (1 to 4), index
/// finger (5 to 8), middle finger (9 to 12), ring finger (13 to 16) and little finger (17 to 20).
struct HandLandmark {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  ///< of the picture
  Eigen::Vector3d world =
      Eigen::Vector3d::Zero();  ///< m from the middle of the hand, axes of the camera frame
};

/// What the networks see of a hand.
struct HandLandmarks {
  static constexpr std::size_t kCount = 21;
  std::array<HandLandmark, kCount> points;
  double presence = 0.0;  ///< probability that there is a hand in the region
  double is_right = 0.0;  ///< probability that it is a right hand, as the picture shows it
  PictureRegion region;   ///< in which the hand was seen
};

/// The networks that find the points of a hand.
struct HandNetworks {
  Network cropper;
  Network landmarker;
};

/// Reads hand_recrop and hand_landmark_full. Throws Error(config) if one is missing.
HandNetworks load_hand_networks(const std::filesystem::path& models);

/// Where the pose says that a hand is: a square about it, turned so that the fingers point up in it. Empty if
/// the hand would be smaller than a few pixels. BGR picture (CV_8UC3); no palm detector is needed.
std::optional<PictureRegion> hand_region(const cv::Mat& picture, const PoseLandmarks& pose, HandSide side,
                                         HandNetworks& networks);

/// The same from a hand that was seen in the frame before.
PictureRegion next_region(const HandLandmarks& hand);

/// The points of a hand in this region of a BGR picture (CV_8UC3); empty if the network sees no hand there.
std::optional<HandLandmarks> hand_in(const cv::Mat& picture, const PictureRegion& region,
                                     HandNetworks& networks);

/// The points of one hand of the person where the pose says that it is.
std::optional<HandLandmarks> find_hand(const cv::Mat& picture, const PoseLandmarks& pose, HandSide side,
                                       HandNetworks& networks);

}  // namespace telemime
