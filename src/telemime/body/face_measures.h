// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "telemime/body/face_model.h"
#include "telemime/body/skeleton.h"

namespace telemime {

/// What is measured on a face in the head's axes. Lengths in mm of the canonical face; up is to the forehead,
/// out is away from the middle of the face. Those of two sides begin with the left one.
enum class FaceMeasure : std::size_t {
  eye_opening,        ///< mean distance of the lids over the width of the eye; of two sides
  lower_lid = 2,      ///< height of the lower lid above the line of the corners over the width; of two sides
  iris_left = 4,      ///< from the middle of the eye to the person's left; of two sides
  iris_up = 6,        ///< above the line of the corners; of two sides
  brow_inner = 8,     ///< above the corners of the eyes; of two sides
  brow_outer = 10,    ///< of two sides
  corner_up = 12,     ///< corner of the mouth above the nose's base; of two sides
  corner_out = 14,    ///< from the nose; of two sides
  upper_lip_up = 16,  ///< edge of the upper lip beside its middle above the nose's base; of two sides
  lower_lip_up = 18,  ///< edge of the lower lip beside its middle above the chin; of two sides
  lips_thick = 20,    ///< upper and lower lip beside the middle; of two sides
  cheek_up = 22,      ///< above the nose's base; of two sides
  nostril_up = 24,    ///< below the bridge of the nose, negative; of two sides
  side_gap = 26,      ///< between the lips beside the middle; of two sides
  chin_down = 28,     ///< below the nose's base
  chin_left,          ///< from the nose
  lip_gap,            ///< between the lips
  mouth_width,
  mouth_left,       ///< middle of the lips, from the nose
  upper_lip_thick,  ///< in the middle
  lower_lip_thick,
  lower_lip_mid_up,  ///< its lower edge above the nose's base, negative
};
inline constexpr std::size_t kFaceMeasureCount = 36;

struct FaceMeasures {
  std::array<double, kFaceMeasureCount> at{};
  double operator[](FaceMeasure m) const { return at[static_cast<std::size_t>(m)]; }
  double of(FaceMeasure m, Side side) const {
    return at[static_cast<std::size_t>(m) + static_cast<std::size_t>(side)];
  }
};

/// The measures of a face of which `fit` is the head.
FaceMeasures measure_face(const FacePoints& points, const HeadFit& fit);

/// The measures of a person's face at rest, seen from the front and from both sides: what a network sees of
/// the same face differs between them. At first they are those of the canonical face, and of the front; then
/// quantiles of what was seen, in bounds about these. What was seen is kept at 64 times for each view, at
/// first every 0.1 s and later less often, so that minutes are remembered. Plain data.
class NeutralFace {
 public:
  NeutralFace();
  /// Learns from a face that is turned by `yaw` (rad, positive to the person's left) at a time, s. Times
  /// before one that was learned from are passed over.
  void learn(const FaceMeasures& seen, double yaw, double time);
  FaceMeasures measures(double yaw) const;

 private:
  struct View {
    std::vector<FaceMeasures> seen;
    double next = 0.0;      ///< time of the next sample, s
    double interval = 0.0;  ///< s; 0: nothing was seen
    FaceMeasures neutral;

    bool add(const FaceMeasures& sample, double time);
    /// The quantiles with `prior` as `copies` samples, fewer the more were seen, and bounds about it.
    void update(const FaceMeasures& prior, std::size_t copies);
  };
  View front_;
  std::array<View, 2> sides_;  ///< turned to the person's left, right
};

}  // namespace telemime
