// SPDX-License-Identifier: Apache-2.0
#include "telemime/nets/pose_landmarks.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "telemime/nets/models/table.h"

namespace telemime {
namespace {

constexpr int kInput = 256;             // pixels
constexpr int kCells = 64;              // of the heat map
constexpr std::size_t kAllPoints = 39;  // of the network: landmarks, two for the next region, four unused
constexpr std::size_t kNextCentre = 33;
constexpr std::size_t kNextTop = 34;
constexpr double kLeastScore = 0.5;

enum Output : std::size_t { kLandmarks, kScore, kHeatMap, kWorld, kMaskFine, kMaskCoarse };

double sigmoid(double value) {
  return 1.0 / (1.0 + std::exp(-value));
}

// A landmark in the coordinates of the region, [0, 1].
struct RegionPoint {
  Eigen::Vector2d place;
  Eigen::Matrix2d covariance;
};

// Refines a landmark by the centre of mass of its heat map in a window about it; the second moment is its
// covariance. Where the heat map has no clear peak, the landmark stays and is as uncertain as the window is
// wide.
RegionPoint refined(const Eigen::Vector2d& place, std::span<const float> heat_map, std::size_t landmark) {
  constexpr int kReach = 3;
  constexpr double kLeastPeak = 0.5;
  constexpr double kCell = 1.0 / kCells;
  constexpr double kWindowVariance = ((2 * kReach + 1) * (2 * kReach + 1) - 1) / 12.0 * kCell * kCell;
  RegionPoint unrefined{.place = place, .covariance = kWindowVariance * Eigen::Matrix2d::Identity()};
  if (!(place.x() >= 0.0 && place.x() < 1.0 && place.y() >= 0.0 && place.y() < 1.0)) {
    return unrefined;
  }
  const int column = static_cast<int>(place.x() * kCells);
  const int row = static_cast<int>(place.y() * kCells);
  double total = 0.0;
  double peak = 0.0;
  Eigen::Vector2d first = Eigen::Vector2d::Zero();
  Eigen::Matrix2d second = Eigen::Matrix2d::Zero();
  for (int y = std::max(row - kReach, 0); y <= std::min(row + kReach, kCells - 1); ++y) {
    for (int x = std::max(column - kReach, 0); x <= std::min(column + kReach, kCells - 1); ++x) {
      const std::size_t cell = static_cast<std::size_t>(y * kCells + x) * kAllPoints + landmark;
      const double weight = sigmoid(heat_map[cell]);
      const Eigen::Vector2d at = kCell * Eigen::Vector2d(x, y);
      peak = std::max(peak, weight);
      total += weight;
      first += weight * at;
      second += weight * at * at.transpose();
    }
  }
  if (peak < kLeastPeak) {
    return unrefined;
  }
  const Eigen::Vector2d mean = first / total;
  // A twelfth of a cell's square is the variance within a cell; it keeps the covariance invertible.
  return {.place = mean,
          .covariance =
              second / total - mean * mean.transpose() + kCell * kCell / 12.0 * Eigen::Matrix2d::Identity()};
}

}  // namespace

Network load_pose_landmarker(const std::filesystem::path& models, PoseModel model) {
  const PoseModelFile file = pose_model_file(model);
  return load_network(models, file.name,
                      {.inputs = {},
                       .outputs = {file.landmarks, file.score, file.heat_map, file.world, file.mask_inputs[0],
                                   file.mask_inputs[1]}});
}

std::optional<SeenPerson> find_landmarks(const cv::Mat& picture, const PictureRegion& region,
                                         Network& landmarker) {
  const InputFormat format{.size = {kInput, kInput}, .black = 0.0F, .white = 1.0F, .repeats_border = true};
  const auto outputs = landmarker.run(network_input(picture, region, format));
  PoseLandmarks result;
  result.score = outputs[kScore][0];
  if (!(result.score >= kLeastScore)) {
    return std::nullopt;
  }
  result.region = region;

  // Each landmark is x, y, z in pixels of the input, then the logits of visibility and presence.
  const Eigen::Matrix2d to_pixels =
      region.rotation() * Eigen::Vector2d(region.width, region.height).asDiagonal();
  std::array<Eigen::Vector2d, kNextTop + 1> pixels;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const float* const values = outputs[kLandmarks].data() + 5 * i;
    const Eigen::Vector2d raw = Eigen::Vector2d(values[0], values[1]) / kInput;
    const RegionPoint point = refined(raw, outputs[kHeatMap], i);
    pixels[i] = region.pixel(point.place);
    if (i < PoseLandmarks::kCount) {
      const float* const world = outputs[kWorld].data() + 3 * i;
      PoseLandmark& landmark = result.points[i];
      landmark.pixel = pixels[i];
      landmark.covariance = to_pixels * point.covariance * to_pixels.transpose();
      landmark.depth = values[2] / kInput * region.width;
      landmark.visibility = sigmoid(values[3]);
      landmark.presence = sigmoid(values[4]);
      landmark.world.head<2>() = region.rotation() * Eigen::Vector2d(world[0], world[1]);
      landmark.world.z() = world[2];
    }
  }
  result.next_region = region_of_axis(pixels[kNextCentre], pixels[kNextTop]);
  const auto copied = [&](Output output) {
    return std::vector<float>(outputs[output].begin(), outputs[output].end());
  };
  return SeenPerson{.landmarks = std::move(result),
                    .mask = {.region = region, .images = {copied(kMaskFine), copied(kMaskCoarse)}}};
}

}  // namespace telemime
