// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "telemime/body/skeleton.h"

namespace telemime {

/// Scales of one segment relative to the default body of the same stature (thesis 3.3, equation 3.4).
struct SegmentScale {
  double length = 1.0;  ///< along the bone (body y at rest)
  double height = 1.0;  ///< front to back (body z at rest)
  double width = 1.0;   ///< side to side (body x at rest)
};

/// The shape of a person: 8 segments x 3 scales (the 24 shape parameters of the thesis), the stature that
/// they scale, and the end of the sleeves.
struct Shape {
  double stature = 1.70;  ///< metres
  std::array<SegmentScale, kSegmentCount> segments{};
  /// End of the sleeves along the arm: 0 shoulder, 1 elbow, 2 wrist; fractions are positions in between.
  double sleeve = 0.5;
  /// Distance between the shoulder joints over that of a default body whose chest is as wide: clothes and
  /// flesh widen a chest without moving its joints.
  double shoulders = 1.0;

  SegmentScale& operator[](Segment s) { return segments[static_cast<std::size_t>(s)]; }
  const SegmentScale& operator[](Segment s) const { return segments[static_cast<std::size_t>(s)]; }
};

}  // namespace telemime
