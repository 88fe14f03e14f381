// SPDX-License-Identifier: Apache-2.0
#include "telemime/nets/face_details.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <tuple>
#include <utility>

#include "telemime/nets/face_landmarks.h"
#include "telemime/nets/models/table.h"
#include "telemime/nets/picture_region.h"

namespace telemime {
namespace {

constexpr int kCells = 48;         // of the image of features
constexpr int kChannels = 32;      // of each cell
constexpr int kPiece = 16;         // cells of the piece
constexpr double kOwnSide = 64.0;  // of the piece, in units of the points that a network finds in it
constexpr double kMargin = 1.5;

// Which points of the mesh each network places, in its order (attributes of the operators in the model's
// file).
constexpr std::array<std::uint16_t, 80> kLips = {
    61, 146, 91, 181, 84, 17, 314, 405, 321, 375, 291, 185, 40, 39, 37, 0,  267, 269, 270, 409,
    78, 95,  88, 178, 87, 14, 317, 402, 318, 324, 308, 191, 80, 81, 82, 13, 312, 311, 310, 415,
    76, 77,  90, 180, 85, 16, 315, 404, 320, 307, 306, 184, 74, 73, 72, 11, 302, 303, 304, 408,
    62, 96,  89, 179, 86, 15, 316, 403, 319, 325, 292, 183, 42, 41, 38, 12, 268, 271, 272, 407};
constexpr std::array<std::uint16_t, 71> kRightEye = {
    33,  7,   163, 144, 145, 153, 154, 155, 133, 246, 161, 160, 159, 158, 157, 173, 130, 25,
    110, 24,  23,  22,  26,  112, 243, 247, 30,  29,  27,  28,  56,  190, 226, 31,  228, 229,
    230, 231, 232, 233, 244, 113, 225, 224, 223, 222, 221, 189, 35,  124, 46,  53,  52,  65,
    143, 111, 117, 118, 119, 120, 121, 128, 245, 156, 70,  63,  105, 66,  107, 55,  193};
constexpr std::array<std::uint16_t, 71> kLeftEye = {
    263, 249, 390, 373, 374, 380, 381, 382, 362, 466, 388, 387, 386, 385, 384, 398, 359, 255,
    339, 254, 253, 252, 256, 341, 463, 467, 260, 259, 257, 258, 286, 414, 446, 261, 448, 449,
    450, 451, 452, 453, 464, 342, 445, 444, 443, 442, 441, 413, 265, 353, 276, 283, 282, 295,
    372, 340, 346, 347, 348, 349, 350, 357, 465, 383, 300, 293, 334, 296, 336, 285, 417};

// The level box around the points of a part, in cells of the features.
PictureRegion piece_of(const FaceDetail& detail, std::span<const Eigen::Vector2d> points, double cell) {
  const Eigen::Vector2d line = points[detail.to] - points[detail.from];
  PictureRegion piece{.angle = std::atan2(line.y(), line.x())};
  const Eigen::Matrix2d turn = piece.rotation();
  Eigen::Vector2d low = turn.transpose() * points[detail.points.front()];
  Eigen::Vector2d high = low;
  for (const std::uint16_t i : detail.points) {
    const Eigen::Vector2d own = turn.transpose() * points[i];
    low = low.cwiseMin(own);
    high = high.cwiseMax(own);
  }
  piece.centre = turn * (0.5 * (low + high)) / cell;
  piece.width = kMargin * (high - low).x() / cell;
  piece.height = kMargin * (high - low).y() / cell;
  return piece;
}

// The features of a piece by bilinear interpolation, 0 outside of the image.
std::vector<float> features_of(const PictureRegion& piece, std::span<const float> features) {
  std::vector<float> result(static_cast<std::size_t>(kPiece) * kPiece * kChannels, 0.0F);
  float* out = result.data();
  for (int row = 0; row < kPiece; ++row) {
    for (int column = 0; column < kPiece; ++column, out += kChannels) {
      const Eigen::Vector2d at =
          piece.pixel((Eigen::Vector2d(column, row).array() + 0.5).matrix() / kPiece).array() - 0.5;
      if (!(at.minCoeff() >= 0.0 && at.maxCoeff() <= kCells - 1)) {
        continue;
      }
      const int x = std::min(static_cast<int>(at.x()), kCells - 2);
      const int y = std::min(static_cast<int>(at.y()), kCells - 2);
      const auto right = static_cast<float>(at.x() - x);
      const auto lower = static_cast<float>(at.y() - y);
      const float* const first = features.data() + static_cast<std::ptrdiff_t>(y * kCells + x) * kChannels;
      const float* const below = first + static_cast<std::ptrdiff_t>(kCells) * kChannels;
      for (int c = 0; c < kChannels; ++c) {
        out[c] = (1.0F - lower) * ((1.0F - right) * first[c] + right * first[c + kChannels]) +
                 lower * ((1.0F - right) * below[c] + right * below[c + kChannels]);
      }
    }
  }
  return result;
}

FaceDetail load(const std::filesystem::path& models, const std::string& input,
                const std::vector<std::string>& outputs) {
  return {.network =
              load_network(models, "face_landmark_with_attention", {.inputs = {input}, .outputs = outputs}),
          .points = {}};
}

}  // namespace

std::vector<FaceDetail> load_face_details(const std::filesystem::path& models) {
  std::vector<FaceDetail> details;
  details.push_back(load(models, "transform_tensor_bilinear_v2", {"conv_lips"}));
  details.push_back(load(models, "transform_tensor_bilinear_v2_1", {"conv_left_eye", "conv_left_iris"}));
  details.push_back(load(models, "transform_tensor_bilinear_v2_2", {"conv_right_eye", "conv_right_iris"}));
  details[0].points = kLips;
  details[1].points = kRightEye;  // on the left of the picture
  details[2].points = kLeftEye;
  std::tie(details[0].from, details[0].to) = std::pair(61, 291);
  std::tie(details[1].from, details[1].to) = std::pair(33, 133);
  std::tie(details[2].from, details[2].to) = std::pair(362, 263);
  details[1].iris = FaceLandmarks::kRightIris;
  details[2].iris = FaceLandmarks::kLeftIris;
  return details;
}

void refine(FaceDetail& detail, std::span<const float> features, double side,
            std::span<Eigen::Vector2d> points) {
  const double cell = side / kCells;
  const PictureRegion piece = piece_of(detail, points, cell);
  const auto found = detail.network.run(features_of(piece, features));
  const auto place = [&](std::span<const float> values, std::size_t i) -> Eigen::Vector2d {
    return cell * piece.pixel(Eigen::Vector2d(values[2 * i], values[2 * i + 1]) / kOwnSide);
  };
  for (std::size_t i = 0; i < detail.points.size(); ++i) {
    points[detail.points[i]] = place(found[0], i);
  }
  constexpr std::size_t kIrisPoints = 5;
  for (std::size_t i = 0; detail.iris >= 0 && i < kIrisPoints; ++i) {
    points[static_cast<std::size_t>(detail.iris) + i] = place(found[1], i);
  }
}

}  // namespace telemime
