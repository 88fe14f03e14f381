// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracking/heuristics/motion_partition.h"

#include "telemime/render/renderer.h"

namespace telemime {
namespace {

SegmentSet segments_of(Part part) {
  SegmentSet set;
  for (std::size_t s = 0; s < kSegmentCount; ++s) {
    set[s] = part_of_segment(static_cast<Segment>(s)) == part;
  }
  return set;
}

}  // namespace

void find_moving_parts(const FilterContext& context, Generation& generation) {
  if (context.labels_before == nullptr || context.labels_before->size() != context.frame.labels.size()) {
    return;
  }
  const Kinematics k = forward_kinematics(context.model.body, context.estimate);
  Rendering whole;
  render(context.model.mesh, k, context.frame.camera, whole);
  Rendering alone;
  PartSet moving;
  for (std::size_t part = 0; part < kPartCount; ++part) {
    render_segments(segments_of(static_cast<Part>(part)), context.model.mesh, k, context.frame.camera, alone);
    int before = 0;  // |A_{t-1} n B_k|
    int now = 0;
    for (int y = alone.top; y < alone.bottom; ++y) {
      const auto row = static_cast<std::size_t>(y) * static_cast<std::size_t>(alone.width);
      const auto* labels_before = context.labels_before->ptr<std::uint8_t>(y);
      const auto* labels_now = context.frame.labels.ptr<std::uint8_t>(y);
      for (int x = alone.left; x < alone.right; ++x) {
        const std::size_t at = row + static_cast<std::size_t>(x);
        const std::uint8_t surface = alone.surface[at];
        if (surface != 0 && alone.inverse_depth[at] >= whole.inverse_depth[at]) {
          before += labels_before[x] == surface;
          now += labels_now[x] == surface;
        }
      }
    }
    moving[part] = before - now >= context.numbers.motion[part] * before;
  }
  generation.moving = has(moving, Part::trunk) ? all_parts() : moving;
}

}  // namespace telemime
