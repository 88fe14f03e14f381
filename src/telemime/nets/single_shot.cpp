// SPDX-License-Identifier: Apache-2.0
#include "telemime/nets/single_shot.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace telemime {
namespace {

constexpr double kLeastScore = 0.5;
constexpr double kMostOverlap = 0.3;

std::vector<Eigen::Vector2d> anchor_points(const SingleShotFormat& format) {
  std::vector<Eigen::Vector2d> points;
  for (const SingleShotFormat::Grid& grid : format.grids) {
    for (int y = 0; y < grid.cells; ++y) {
      for (int x = 0; x < grid.cells; ++x) {
        points.insert(points.end(), static_cast<std::size_t>(grid.anchors),
                      {(x + 0.5) / grid.cells, (y + 0.5) / grid.cells});
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

// The mean of candidates, weighted by score; the first is the best.
Detection mean_of(const std::vector<Detection>& candidates) {
  Detection mean = candidates.front();
  mean.box *= mean.score;
  for (Eigen::Vector2d& point : mean.keypoints) {
    point *= mean.score;
  }
  double total = mean.score;
  for (auto other = candidates.begin() + 1; other != candidates.end(); ++other) {
    total += other->score;
    mean.box += other->score * other->box;
    for (std::size_t k = 0; k < mean.keypoints.size(); ++k) {
      mean.keypoints[k] += other->score * other->keypoints[k];
    }
  }
  mean.box /= total;
  for (Eigen::Vector2d& point : mean.keypoints) {
    point /= total;
  }
  return mean;
}

std::vector<Detection> merged(std::vector<Detection> candidates) {
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Detection& a, const Detection& b) { return a.score > b.score; });
  std::vector<Detection> found;
  while (!candidates.empty()) {
    std::vector<Detection> same;
    std::vector<Detection> rest;
    for (Detection& candidate : candidates) {
      const bool overlaps = same.empty() || overlap(same.front().box, candidate.box) > kMostOverlap;
      (overlaps ? same : rest).push_back(std::move(candidate));
    }
    found.push_back(mean_of(same));
    candidates = std::move(rest);
  }
  return found;
}

}  // namespace

std::vector<Detection> detect(const cv::Mat& picture, const PictureRegion& region, Network& network,
                              const SingleShotFormat& format) {
  const InputFormat input{
      .size = {format.input, format.input}, .black = -1.0F, .white = 1.0F, .repeats_border = false};
  const auto outputs = network.run(network_input(picture, region, input));
  const std::vector<Eigen::Vector2d> anchors = anchor_points(format);
  const std::size_t numbers = 4 + 2 * format.keypoints;
  std::vector<Detection> candidates;
  for (std::size_t i = 0; i < anchors.size(); ++i) {
    const double score = 1.0 / (1.0 + std::exp(-std::clamp<double>(outputs[1][i], -100.0, 100.0)));
    if (score <= kLeastScore) {
      continue;
    }
    const float* const values = outputs[0].data() + numbers * i;
    const auto point = [&](std::size_t k) -> Eigen::Vector2d {
      return Eigen::Vector2d(values[k], values[k + 1]) / format.input;
    };
    const Eigen::Vector2d centre = anchors[i] + point(0);
    const Eigen::Vector2d half = 0.5 * point(2);
    Detection& candidate = candidates.emplace_back();
    candidate.score = score;
    candidate.box << region.pixel(centre - half), region.pixel(centre + half);
    for (std::size_t k = 0; k < format.keypoints; ++k) {
      candidate.keypoints.push_back(region.pixel(anchors[i] + point(4 + 2 * k)));
    }
  }
  return merged(std::move(candidates));
}

}  // namespace telemime
