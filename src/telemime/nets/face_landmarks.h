// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "telemime/nets/face_details.h"
#include "telemime/nets/network.h"
#include "telemime/nets/picture_region.h"
#include "telemime/nets/pose_landmarks.h"

namespace telemime {

/// A point of the surface of a face.
struct FaceLandmark {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  ///< of the picture
  double depth = 0.0;  ///< behind the middle of the head, in pixels as the picture's axes
};

/// What the networks see of a face: the points of MediaPipe's canonical face mesh, then five points of each
/// iris (the middle first), the right one before the left one.
struct FaceLandmarks {
  static constexpr std::size_t kMeshCount = 468;
  static constexpr std::size_t kCount = 478;
  static constexpr int kRightIris = 468;  ///< its middle
  static constexpr int kLeftIris = 473;
  std::array<FaceLandmark, kCount> points;
  /// The same points, seen again in a smaller region: the mean of both looks is nearer to the truth, and how
  /// much they differ is how little the networks know. Empty: there was no second look, or it showed no face.
  std::optional<std::array<FaceLandmark, kCount>> again;
  double presence = 0.0;      ///< probability that there is a face in the region
  PictureRegion next_region;  ///< in which to look for the face in the next frame
};

/// The networks that find a face and its points.
struct FaceNetworks {
  Network detector;
  Network mesh;                     ///< to kFaceMeshOutputs
  std::vector<FaceDetail> details;  ///< the lips and the eyes
};

/// Points of the mesh, presence, and the features for the details: of face_landmark_with_attention.
inline const std::vector<std::string> kFaceMeshOutputs = {"output_mesh", "conv_faceflag", "p_re_lu_3"};

/// Reads face_detection_short_range and face_landmark_with_attention. Throws Error(config) if one is missing.
FaceNetworks load_face_networks(const std::filesystem::path& models);

/// The square around the head of a person, in which the face is to be searched.
PictureRegion head_region(const PoseLandmarks& pose);

/// The face in this square region of a BGR picture (CV_8UC3), such as next_region of the frame before; empty
/// if there is none. The network looks twice: the second region is level by the first look, five sixths as
/// wide as next_region, and a little aside.
std::optional<FaceLandmarks> face_in(const cv::Mat& picture, const PictureRegion& region,
                                     FaceNetworks& networks);

/// The visible face nearest to the centre of this square region, by the detector; looked at as in face_in().
/// Empty if no face is found.
std::optional<FaceLandmarks> find_face(const cv::Mat& picture, const PictureRegion& search,
                                       FaceNetworks& networks);

}  // namespace telemime
