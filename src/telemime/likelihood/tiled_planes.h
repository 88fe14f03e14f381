// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace telemime {

/// Memory layout of planes in tiles of 4 x 4 pixels: tile after tile from left to right and from top to
/// bottom, the 16 pixels of a tile in rows. A tile of 32-bit numbers fills one cache line, and most pieces of
/// a projected surface touch few tiles. The grid is `kMargin` tiles wider and higher than the image, so that
/// blocks of tiles that begin in the image end in the grid.
struct TileGrid {
  static constexpr int kSide = 4;
  static constexpr int kPixels = kSide * kSide;
  static constexpr int kMargin = 2;

  int width = 0;  ///< px, of the image
  int height = 0;
  int columns = 0;  ///< tiles
  int rows = 0;

  std::size_t tiles() const { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); }
  std::size_t pixels() const { return tiles() * kPixels; }
  /// Index of a pixel of the image.
  std::size_t index(int x, int y) const {
    const auto at = [](int i) { return static_cast<std::size_t>(i); };
    const std::size_t tile = at(y / kSide) * at(columns) + at(x / kSide);
    return tile * kPixels + at(y % kSide) * kSide + at(x % kSide);
  }
};

TileGrid tile_grid(int width, int height);

/// Planes of a frame that an evaluation reads, in tiles.
struct TiledPlanes {
  /// Code of a pixel that counts nowhere; other labels have 8 times their class (0: background).
  static constexpr std::uint8_t kUnknown = 0x80;
  /// Distances are whole numbers below this: their sum is the same in any order.
  static constexpr std::int32_t kDistanceEnd = 1 << 22;

  TileGrid grid;
  std::vector<std::uint8_t> labels;    ///< codes; kUnknown outside the image
  std::vector<std::int32_t> distance;  ///< in units; 0 outside the image; one more number at the end
  float distance_units = 1.0F;         ///< of a pixel, a power of two: as many as the largest distance allows
  std::shared_ptr<const void> content;  ///< another one after each tile(); copies share it
};

/// Copies labels (h x w, CV_8UC1) and distance map (h x w, CV_32FC1) into tiles. The memory of `out` is
/// reused.
void tile(const cv::Mat& labels, const cv::Mat& distance, TiledPlanes& out);

}  // namespace telemime
