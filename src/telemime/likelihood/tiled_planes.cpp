// SPDX-License-Identifier: Apache-2.0
#include "telemime/likelihood/tiled_planes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "telemime/body/mesh.h"

namespace telemime {
namespace {

// At least 1: tiny distances need no more digits. At most a million pixels.
float largest(const cv::Mat& distance) {
  constexpr float kMost = 1e6F;
  float most = 1.0F;
  for (int y = 0; y < distance.rows; ++y) {
    const auto* row = distance.ptr<float>(y);
    for (int x = 0; x < distance.cols; ++x) {
      most = std::max(most, row[x]);
    }
  }
  return std::min(most, kMost);
}

}  // namespace

TileGrid tile_grid(int width, int height) {
  constexpr int kSide = TileGrid::kSide;
  return {width, height, (width + kSide - 1) / kSide + TileGrid::kMargin,
          (height + kSide - 1) / kSide + TileGrid::kMargin};
}

void tile(const cv::Mat& labels, const cv::Mat& distance, TiledPlanes& out) {
  const TileGrid grid = tile_grid(labels.cols, labels.rows);
  if (out.grid.width != grid.width || out.grid.height != grid.height) {
    out.grid = grid;
    out.labels.assign(grid.pixels(), TiledPlanes::kUnknown);
    out.distance.assign(grid.pixels() + 1, 0);
  }
  out.content = std::make_shared<char>();
  const float most = largest(distance);
  out.distance_units =
      std::ldexp(1.0F, std::ilogb(static_cast<float>(TiledPlanes::kDistanceEnd)) - 1 - std::ilogb(most));
  std::array<std::uint8_t, 256> code{};
  code.fill(TiledPlanes::kUnknown);
  for (std::uint8_t c = 0; c <= kSurfaceClassCount; ++c) {
    code[c] = static_cast<std::uint8_t>(8 * c);
  }
  for (int y = 0; y < grid.height; ++y) {
    const auto* label = labels.ptr<std::uint8_t>(y);
    const auto* pixel = distance.ptr<float>(y);
    std::size_t at = grid.index(0, y);
    for (int x = 0; x < grid.width; x += TileGrid::kSide, at += TileGrid::kPixels) {
      const int columns = std::min(TileGrid::kSide, grid.width - x);
      for (int i = 0; i < columns; ++i) {
        out.labels[at + static_cast<std::size_t>(i)] = code[label[x + i]];
        const float px = std::min(most, pixel[x + i]);  // also of what is not a number
        out.distance[at + static_cast<std::size_t>(i)] = static_cast<std::int32_t>(px * out.distance_units);
      }
    }
  }
}

}  // namespace telemime
