// SPDX-License-Identifier: Apache-2.0
#include "telemime/likelihood/tiled_planes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <string>
#include <utility>

#include "telemime/core/random.h"

namespace telemime {
namespace {

constexpr std::pair<int, int> kSizes[] = {{1, 1}, {3, 5}, {5, 7}, {4, 4}, {159, 119}, {160, 120}, {641, 479}};

struct Planes {
  cv::Mat labels;
  cv::Mat distance;
};

// Every label occurs, and no two neighbours have the same distance.
Planes random_planes(int width, int height, std::uint64_t seed, double farthest = 100.0) {
  Planes planes = {cv::Mat(height, width, CV_8UC1), cv::Mat(height, width, CV_32FC1)};
  Random random(seed);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      planes.labels.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(random.below(256));
      const double most = random.below(20) == 0 ? farthest : 20.0;
      const double distance = random.below(100) == 0 ? std::nan("") : random.uniform(1.0, most);
      planes.distance.at<float>(y, x) = static_cast<float>(distance);
    }
  }
  return planes;
}

std::uint8_t code_of(std::uint8_t label) {
  return label <= 3 ? static_cast<std::uint8_t>(8 * label) : TiledPlanes::kUnknown;
}

// Every pixel has its value, and all other positions are unknown.
void expect_holds(const TiledPlanes& tiles, const Planes& planes) {
  const TileGrid& grid = tiles.grid;
  ASSERT_EQ(grid.width, planes.labels.cols);
  ASSERT_EQ(grid.height, planes.labels.rows);
  ASSERT_EQ(tiles.labels.size(), grid.pixels());
  ASSERT_EQ(tiles.distance.size(), grid.pixels() + 1);
  std::vector<std::uint8_t> labels(grid.pixels(), TiledPlanes::kUnknown);
  double most = 1.0;  // px; what is not a number counts as the largest
  cv::minMaxLoc(planes.distance, nullptr, &most, nullptr, nullptr, planes.distance == planes.distance);
  most = std::clamp(most, 1.0, 1e6);
  std::vector<bool> taken(grid.pixels(), false);
  for (int y = 0; y < grid.height; ++y) {
    for (int x = 0; x < grid.width; ++x) {
      const std::size_t at = grid.index(x, y);
      ASSERT_LT(at, grid.pixels());
      ASSERT_FALSE(taken[at]) << "two pixels at one place: " << x << " " << y;
      taken[at] = true;
      labels[at] = code_of(planes.labels.at<std::uint8_t>(y, x));
      const float px = planes.distance.at<float>(y, x);
      const double expected = std::isnan(px) ? most : std::min<double>(px, most);
      const double held = tiles.distance[at] / static_cast<double>(tiles.distance_units);
      ASSERT_LE(held, expected);
      ASSERT_LT(expected - held, 1e-6 * most) << x << " " << y;
      ASSERT_LT(tiles.distance[at], TiledPlanes::kDistanceEnd);
    }
  }
  ASSERT_TRUE(tiles.labels == labels);
  for (std::size_t at = 0; at < tiles.distance.size(); ++at) {
    ASSERT_TRUE((at < grid.pixels() && taken[at]) || tiles.distance[at] == 0);
  }
}

TEST(TiledPlanes, HoldEveryPixelAndNothingElse) {
  for (const auto& [width, height] : kSizes) {
    SCOPED_TRACE(std::to_string(width) + " x " + std::to_string(height));
    for (const double farthest : {20.0, 1000.0, 1e7}) {
      const Planes planes = random_planes(width, height, 1, farthest);
      TiledPlanes tiles;
      tile(planes.labels, planes.distance, tiles);
      expect_holds(tiles, planes);
    }
  }
}

TEST(TiledPlanes, GridIsAsSmallAsItCanBeWithItsMargin) {
  for (const auto& [width, height] : kSizes) {
    const TileGrid grid = tile_grid(width, height);
    const int columns = grid.columns - TileGrid::kMargin;
    const int rows = grid.rows - TileGrid::kMargin;
    EXPECT_GE(columns * TileGrid::kSide, width);
    EXPECT_LT((columns - 1) * TileGrid::kSide, width);
    EXPECT_GE(rows * TileGrid::kSide, height);
    EXPECT_LT((rows - 1) * TileGrid::kSide, height);
    EXPECT_EQ(grid.pixels(), static_cast<std::size_t>(grid.columns * grid.rows * TileGrid::kPixels));
  }
}

TEST(TiledPlanes, GoThroughTilesInRows) {
  const TileGrid grid = tile_grid(9, 6);  // 3 x 2 tiles and the margin
  EXPECT_EQ(grid.columns, 5);
  EXPECT_EQ(grid.rows, 4);
  EXPECT_EQ(grid.index(0, 0), 0U);
  EXPECT_EQ(grid.index(3, 0), 3U);
  EXPECT_EQ(grid.index(0, 1), 4U);
  EXPECT_EQ(grid.index(3, 3), 15U);
  EXPECT_EQ(grid.index(4, 0), 16U);
  EXPECT_EQ(grid.index(8, 2), 40U);
  EXPECT_EQ(grid.index(0, 4), 80U);
  EXPECT_EQ(grid.index(5, 5), 101U);
}

TEST(TiledPlanes, HaveACodeForEveryLabel) {
  cv::Mat labels(1, 256, CV_8UC1);
  for (int i = 0; i < 256; ++i) {
    labels.at<std::uint8_t>(0, i) = static_cast<std::uint8_t>(i);
  }
  TiledPlanes tiles;
  tile(labels, cv::Mat::zeros(1, 256, CV_32FC1), tiles);
  const auto code = [&](int label) { return int{tiles.labels[tiles.grid.index(label, 0)]}; };
  EXPECT_EQ(code(0), 0);
  EXPECT_EQ(code(1), 8);
  EXPECT_EQ(code(2), 16);
  EXPECT_EQ(code(3), 24);
  for (int label = 4; label < 256; ++label) {
    EXPECT_EQ(code(label), 0x80) << label;
  }
}

TEST(TiledPlanes, MemoryIsUsedAgainWithoutATrace) {
  TiledPlanes tiles;
  std::uint64_t seed = 10;
  // Larger, smaller, the same again with other content; sizes that have the same number of tiles.
  for (const auto& [width, height] :
       {std::pair(40, 30), std::pair(7, 5), std::pair(7, 5), std::pair(5, 7), std::pair(8, 8),
        std::pair(5, 5), std::pair(61, 33), std::pair(61, 33)}) {
    SCOPED_TRACE(std::to_string(width) + " x " + std::to_string(height));
    const Planes planes = random_planes(width, height, ++seed);
    tile(planes.labels, planes.distance, tiles);
    expect_holds(tiles, planes);
  }
  const std::int32_t* memory = tiles.distance.data();
  const Planes last = random_planes(61, 33, 99);
  tile(last.labels, last.distance, tiles);
  EXPECT_EQ(tiles.distance.data(), memory) << "images of one size need memory once";
}

TEST(TiledPlanes, TakePiecesOfBiggerImages) {
  const Planes big = random_planes(50, 40, 3);
  for (const cv::Rect& piece :
       {cv::Rect(0, 0, 50, 40), cv::Rect(7, 11, 33, 21), cv::Rect(49, 39, 1, 1), cv::Rect(3, 0, 5, 40)}) {
    const Planes view = {big.labels(piece), big.distance(piece)};
    TiledPlanes tiles;
    tile(view.labels, view.distance, tiles);
    expect_holds(tiles, view);
  }
}

}  // namespace
}  // namespace telemime
