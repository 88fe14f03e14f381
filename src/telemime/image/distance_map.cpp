// SPDX-License-Identifier: Apache-2.0
#include "telemime/image/edges.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace telemime {
namespace {

// Lengths of the chamfer steps in 1/65536 px: to an edge neighbour, a corner neighbour and by a knight's
// move.
constexpr std::int32_t kOne = 1 << 16;
constexpr std::int32_t kBeside = kOne;
constexpr std::int32_t kCorner = 91750;
constexpr std::int32_t kKnight = 143976;
constexpr std::int32_t kFar = 1 << 29;
constexpr int kBorder = 2;  // width of the border of far pixels, so that every pixel has all neighbours

/// Lowers the distances of `row` to those by way of the two previous rows: `near` is adjacent, `next` is
/// beyond it (above on the pass down, below on the pass up). The loop is vectorised by the compiler.
void from_rows(const std::int32_t* near, const std::int32_t* next, int columns, std::int32_t* row) {
  for (int c = 0; c < columns; ++c) {
    const std::int32_t corner = std::min(near[c - 1], near[c + 1]) + kCorner;
    const std::int32_t wide = std::min(near[c - 2], near[c + 2]) + kKnight;
    const std::int32_t high = std::min(next[c - 1], next[c + 1]) + kKnight;
    const std::int32_t straight = near[c] + kBeside;
    row[c] = std::min(row[c], std::min(std::min(straight, corner), std::min(wide, high)));
  }
}

}  // namespace

cv::Mat distance_map(const cv::Mat& edges, double cap) {
  cv::Mat distance(edges.size(), CV_32FC1, cv::Scalar(cap));
  const cv::Rect edged = cv::boundingRect(edges);
  if (edged.empty()) {
    return distance;
  }
  // Pixels farther than `cap` rows or columns from all edges have the distance `cap`: leave them out.
  const int reach = static_cast<int>(std::min(std::ceil(cap), 1.0 * (edges.cols + edges.rows)));
  const cv::Rect near = cv::Rect(edged.tl() - cv::Point(reach, reach), edged.br() + cv::Point(reach, reach)) &
                        cv::Rect(cv::Point(0, 0), edges.size());
  // Pass down: distances to edges above and to the left.
  const std::ptrdiff_t stride = near.width + 2 * kBorder;
  std::vector<std::int32_t> steps(static_cast<std::size_t>(stride * (near.height + 2 * kBorder)), kFar);
  const auto row_of = [&](int r) { return steps.data() + (r + kBorder) * stride + kBorder; };
  for (int r = 0; r < near.height; ++r) {
    std::int32_t* const row = row_of(r);
    const auto* const edge = edges.ptr<unsigned char>(near.y + r) + near.x;
    for (int c = 0; c < near.width; ++c) {
      row[c] = edge[c] != 0 ? 0 : kFar;
    }
    from_rows(row_of(r - 1), row_of(r - 2), near.width, row);
    std::int32_t beside = kFar;
    for (int c = 0; c < near.width; ++c) {
      beside = std::min(beside + kBeside, row[c]);
      row[c] = beside;
    }
  }
  // Pass up: distances to edges below and to the right.
  const auto most = static_cast<float>(cap);
  for (int r = near.height - 1; r >= 0; --r) {
    std::int32_t* const row = row_of(r);
    from_rows(row_of(r + 1), row_of(r + 2), near.width, row);
    std::int32_t beside = kFar;
    for (int c = near.width - 1; c >= 0; --c) {
      beside = std::min(beside + kBeside, row[c]);
      row[c] = beside;
    }
    auto* const out = distance.ptr<float>(near.y + r) + near.x;
    for (int c = 0; c < near.width; ++c) {
      const float d = static_cast<float>(row[c]) * (1.0F / static_cast<float>(kOne));
      out[c] = d < most ? d : most;
    }
  }
  return distance;
}

}  // namespace telemime
