// SPDX-License-Identifier: Apache-2.0
#include "telemime/nets/face_landmarks.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "telemime/nets/models/table.h"
#include "telemime/nets/single_shot.h"

namespace telemime {
namespace {

constexpr int kInput = 192;  // pixels
constexpr double kLeastPresence = 0.5;
constexpr double kMargin = 1.5;  // side of the square, in sides of the face
constexpr std::size_t kRightEyeCorner = 33;
constexpr std::size_t kLeftEyeCorner = 263;

// The square around a face in which the line from the right to the left eye is level.
PictureRegion level_square(const std::vector<Eigen::Vector2d>& points) {
  const Eigen::Vector2d eyes = points[kLeftEyeCorner] - points[kRightEyeCorner];
  PictureRegion region;
  region.angle = std::atan2(eyes.y(), eyes.x());
  const Eigen::Matrix2d turn = region.rotation();
  Eigen::Vector2d low = turn.transpose() * points.front();
  Eigen::Vector2d high = low;
  for (const Eigen::Vector2d& point : points) {
    const Eigen::Vector2d own = turn.transpose() * point;
    low = low.cwiseMin(own);
    high = high.cwiseMax(own);
  }
  region.centre = turn * (0.5 * (low + high));
  region.width = region.height = kMargin * (high - low).maxCoeff();
  return region;
}

std::optional<FaceLandmarks> landmarks_in(const cv::Mat& picture, const PictureRegion& region,
                                          FaceNetworks& networks) {
  const InputFormat format{.size = {kInput, kInput}};
  const auto outputs = networks.mesh.run(network_input(picture, region, format));
  FaceLandmarks face;
  face.presence = 1.0 / (1.0 + std::exp(-outputs[1][0]));
  if (!(face.presence >= kLeastPresence)) {
    return std::nullopt;
  }
  std::vector<Eigen::Vector2d> points(FaceLandmarks::kCount, Eigen::Vector2d::Zero());
  for (std::size_t i = 0; i < FaceLandmarks::kMeshCount; ++i) {
    const float* const values = outputs[0].data() + 3 * i;
    points[i] = {values[0], values[1]};
    face.points[i].depth = values[2] / kInput * region.width;
  }
  for (FaceDetail& detail : networks.details) {
    refine(detail, outputs[2], kInput, points);
  }
  for (std::size_t i = 0; i < FaceLandmarks::kCount; ++i) {
    points[i] = region.pixel(points[i] / kInput);
    face.points[i].pixel = points[i];
  }
  // An iris has the depth of its eye.
  for (const auto& [iris, corners] : {std::pair(FaceLandmarks::kRightIris, std::pair(33, 133)),
                                      std::pair(FaceLandmarks::kLeftIris, std::pair(362, 263))}) {
    for (int i = iris; i < iris + 5; ++i) {
      face.points[i].depth = 0.5 * (face.points[corners.first].depth + face.points[corners.second].depth);
    }
  }
  points.resize(FaceLandmarks::kMeshCount);
  face.next_region = level_square(points);
  return face;
}

}  // namespace

FaceNetworks load_face_networks(const std::filesystem::path& models) {
  const std::vector<std::string> detector_outputs = {"regressors", "classificators"};
  return {.detector =
              load_network(models, "face_detection_short_range", {.inputs = {}, .outputs = detector_outputs}),
          .mesh = load_network(models, "face_landmark_with_attention",
                               {.inputs = {}, .outputs = kFaceMeshOutputs}),
          .details = load_face_details(models)};
}

std::optional<FaceLandmarks> face_in(const cv::Mat& picture, const PictureRegion& region,
                                     FaceNetworks& networks) {
  constexpr double kAside = 0.03;  // of its width
  constexpr double kSmaller = 1.25 / kMargin;
  std::optional<FaceLandmarks> face = landmarks_in(picture, region, networks);
  if (face) {
    PictureRegion second = face->next_region;  // which the first look has centred and levelled
    second.width *= kSmaller;
    second.height *= kSmaller;
    second.centre += kAside * second.width * Eigen::Vector2d(1.0, 1.0);
    const std::optional<FaceLandmarks> again = landmarks_in(picture, second, networks);
    face->again = again ? std::optional(again->points) : std::nullopt;
  }
  return face;
}

PictureRegion head_region(const PoseLandmarks& pose) {
  using Index = PoseLandmarkIndex;
  const auto distance = [&](int a, int b) { return (pose.points[a].pixel - pose.points[b].pixel).norm(); };
  // The sum changes little with the direction of the head: one part of it is across the face, the other along
  // it.
  constexpr double kSide = 4.0;
  const double side = kSide * (distance(Index::left_eye, Index::right_eye) +
                               std::max(distance(Index::left_eye, Index::mouth_left),
                                        distance(Index::right_eye, Index::mouth_right)));
  return {.centre = pose.points[Index::nose].pixel, .width = side, .height = side};
}

std::optional<FaceLandmarks> find_face(const cv::Mat& picture, const PictureRegion& search,
                                       FaceNetworks& networks) {
  // Keypoints of a face: its right eye, left eye, nose, mouth, right ear, left ear.
  const SingleShotFormat format{.input = 128, .grids = {{16, 2}, {8, 6}}, .keypoints = 6};
  std::vector<Detection> faces = detect(picture, search, networks.detector, format);
  const auto away = [&search](const Detection& face) {
    return (0.5 * (face.box.head<2>() + face.box.tail<2>()) - search.centre).norm();
  };
  std::stable_sort(faces.begin(), faces.end(),
                   [&](const Detection& a, const Detection& b) { return away(a) < away(b); });
  for (const Detection& face : faces) {
    const Eigen::Vector2d eyes = face.keypoints[1] - face.keypoints[0];
    const double side = kMargin * (face.box.tail<2>() - face.box.head<2>()).cwiseAbs().maxCoeff();
    const PictureRegion region{.centre = 0.5 * (face.box.head<2>() + face.box.tail<2>()),
                               .width = side,
                               .height = side,
                               .angle = std::atan2(eyes.y(), eyes.x())};
    if (std::optional<FaceLandmarks> found = face_in(picture, region, networks)) {
      return found;
    }
  }
  return std::nullopt;
}

}  // namespace telemime
