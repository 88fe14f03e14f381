// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "telemime/body/mesh.h"

namespace telemime {

/// What a likelihood back end counts for one pose against one frame. Cues turn these numbers into costs, so
/// that back ends know reductions and cues know formulas, and neither multiplies the other.
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

/// Which reductions a batch needs: the contour costs extra.
enum class Reduction : unsigned { overlap = 1, contour = 2, all = 3 };
constexpr bool wants(Reduction asked, Reduction part) {
  return (static_cast<unsigned>(asked) & static_cast<unsigned>(part)) != 0;
}

}  // namespace telemime
