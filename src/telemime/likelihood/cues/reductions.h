// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "telemime/body/mesh.h"

namespace telemime {

/// What a back end counts for one pose against one frame. Back ends know reductions, cues know formulas: a
/// new cue needs no change in any back end, and a new back end none in any cue.
struct Reductions {
  /// Pixels by class (index SurfaceClass - 1): in the image, in the projected model, in both. Pixels whose
  /// label is "ignore" count nowhere.
  std::array<std::int32_t, kSurfaceClassCount> observed{};
  std::array<std::int32_t, kSurfaceClassCount> model{};
  std::array<std::int32_t, kSurfaceClassCount> both{};
  /// Sum (pixels) of the distance map over the visible occluding contour, and how many points it has.
  double contour_sum = 0.0;
  std::int32_t contour_points = 0;
};

/// Which reductions a batch needs: counting the contour takes additional time.
enum class Reduction : unsigned { none = 0, overlap = 1, contour = 2, all = 3 };
constexpr Reduction operator|(Reduction a, Reduction b) {
  return static_cast<Reduction>(static_cast<unsigned>(a) | static_cast<unsigned>(b));
}
/// Whether `asked` contains any part of `part`.
constexpr bool wants(Reduction asked, Reduction part) {
  return (static_cast<unsigned>(asked) & static_cast<unsigned>(part)) != 0;
}
/// Whether `asked` contains all of `part`.
constexpr bool covers(Reduction asked, Reduction part) {
  return (asked | part) == asked;
}

}  // namespace telemime
