// SPDX-License-Identifier: Apache-2.0
#include "telemime/nets/pose_detector.h"

#include <algorithm>
#include <cmath>

#include "telemime/nets/models/table.h"

namespace telemime {
namespace {

constexpr double kInput = 224.0;  // pixels
constexpr double kLeastScore = 0.5;
constexpr double kMostOverlap = 0.3;
constexpr std::size_t kValues = 12;  // centre and size of the box, then four points

// Boxes are predicted relative to points on three grids, several for each point.
struct AnchorGrid {
  int cells;
  int anchors;
};
constexpr std::array<AnchorGrid, 3> kGrids = {{{28, 2}, {14, 2}, {7, 6}}};

std::vector<Eigen::Vector2d> anchor_points() {
  std::vector<Eigen::Vector2d> points;
  for (const AnchorGrid& grid : kGrids) {
    for (int y = 0; y < grid.cells; ++y) {
      for (int x = 0; x < grid.cells; ++x) {
        points.insert(points.end(), grid.anchors, {(x + 0.5) / grid.cells, (y + 0.5) / grid.cells});
      }
    }
  }
  return points;
}

double area(const Eigen::Vector4d& box) {
  return std::max(box[2] - box[0], 0.0) * std::max(box[3] - box[1], 0.0);
}

// Intersection over union.
double overlap(const Eigen::Vector4d& a, const Eigen::Vector4d& b) {
  const Eigen::Vector4d common(std::max(a[0], b[0]), std::max(a[1], b[1]), std::min(a[2], b[2]),
                               std::min(a[3], b[3]));
  const double both = area(common);
  const double either = area(a) + area(b) - both;
  return either > 0.0 ? both / either : 0.0;
}

// Weighted non-maximum suppression: the best candidate takes the mean of those that it overlaps.
std::vector<PoseDetection> merged(std::vector<PoseDetection> candidates) {
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const PoseDetection& a, const PoseDetection& b) { return a.score > b.score; });
  std::vector<PoseDetection> people;
  while (!candidates.empty()) {
    const Eigen::Vector4d best = candidates.front().box;
    const auto rest = std::stable_partition(
        candidates.begin(), candidates.end(),
        [&](const PoseDetection& other) { return overlap(best, other.box) > kMostOverlap; });
    if (rest == candidates.begin()) {  // a box without area does not even overlap itself
      candidates.erase(candidates.begin());
      continue;
    }
    PoseDetection person{.score = candidates.front().score, .box = Eigen::Vector4d::Zero(), .keypoints = {}};
    person.keypoints.fill(Eigen::Vector2d::Zero());
    double total = 0.0;
    for (auto each = candidates.begin(); each != rest; ++each) {
      total += each->score;
      person.box += each->score * each->box;
      for (std::size_t k = 0; k < person.keypoints.size(); ++k) {
        person.keypoints[k] += each->score * each->keypoints[k];
      }
    }
    person.box /= total;
    for (Eigen::Vector2d& point : person.keypoints) {
      point /= total;
    }
    people.push_back(person);
    candidates.erase(candidates.begin(), rest);
  }
  return people;
}

}  // namespace

Network load_pose_detector(const std::filesystem::path& models) {
  const std::array<std::string, 2> outputs = {"Identity", "Identity_1"};  // boxes, scores
  return load_network(models, "pose_detection", outputs);
}

std::vector<PoseDetection> detect_poses(const cv::Mat& picture, Network& detector) {
  const PictureRegion region = square_around(picture);
  const InputFormat format{.size = {static_cast<int>(kInput), static_cast<int>(kInput)},
                           .black = -1.0F,
                           .white = 1.0F,
                           .repeats_border = false};
  const auto outputs = detector.run(network_input(picture, region, format));
  static const std::vector<Eigen::Vector2d> kAnchors = anchor_points();
  std::vector<PoseDetection> candidates;
  for (std::size_t i = 0; i < kAnchors.size(); ++i) {
    const double score = 1.0 / (1.0 + std::exp(-std::clamp<double>(outputs[1][i], -100.0, 100.0)));
    if (score <= kLeastScore) {
      continue;
    }
    const float* const values = outputs[0].data() + kValues * i;
    const auto point = [&](std::size_t k) -> Eigen::Vector2d {
      return Eigen::Vector2d(values[k], values[k + 1]) / kInput;
    };
    const Eigen::Vector2d centre = kAnchors[i] + point(0);
    const Eigen::Vector2d half = 0.5 * point(2);
    PoseDetection candidate{.score = score, .box = {}, .keypoints = {}};
    candidate.box << region.pixel(centre - half), region.pixel(centre + half);
    for (std::size_t k = 0; k < candidate.keypoints.size(); ++k) {
      candidate.keypoints[k] = region.pixel(kAnchors[i] + point(4 + 2 * k));
    }
    candidates.push_back(candidate);
  }
  return merged(std::move(candidates));
}

PictureRegion region_of(const PoseDetection& detection) {
  return region_of_axis(detection.keypoints[0], detection.keypoints[1]);
}

}  // namespace telemime
