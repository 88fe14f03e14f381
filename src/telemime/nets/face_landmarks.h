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

/// A point of the surface of a face.
struct FaceLandmark {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  ///< of the picture
  double depth = 0.0;  ///< behind the middle of the head, in pixels as the picture's axes
};

/// What the networks see of a face: the points of MediaPipe's canonical face mesh.
struct FaceLandmarks {
  static constexpr std::size_t kCount = 468;
  std::array<FaceLandmark, kCount> points;
  double presence = 0.0;      ///< probability that there is a face in the region
  PictureRegion region;       ///< in which the face was seen
  PictureRegion next_region;  ///< in which to look for the face in the next frame
};

/// The networks that find a face and its points.
struct FaceNetworks {
  Network detector;
  Network landmarker;
};

/// Reads face_detection_short_range and face_landmark. Throws Error(config) if one is missing.
FaceNetworks load_face_networks(const std::filesystem::path& models);

/// The square around the head of a person, in which the face is to be searched.
PictureRegion head_region(const PoseLandmarks& pose);

/// The points of the best visible face in this square region of a BGR picture (CV_8UC3). `previous` is
/// next_region of the frame before; the detector runs only without it or if there is no face any more. Empty
/// if no face is found.
std::optional<FaceLandmarks> find_face(const cv::Mat& picture, const PictureRegion& search,
                                       FaceNetworks& networks,
                                       const std::optional<PictureRegion>& previous = std::nullopt);

}  // namespace telemime
