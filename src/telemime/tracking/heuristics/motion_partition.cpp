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

std::array<double, kPartCount> uncovered_shares(const cv::Mat& before, const cv::Mat& now, const Model& model,
                                                const Pose& pose, const Camera& camera) {
  const Kinematics k = forward_kinematics(model.body, pose);
  Rendering whole;
  render(model.mesh, k, camera, whole);
  Rendering alone;
  std::array<double, kPartCount> shares{};
  for (std::size_t part = 0; part < kPartCount; ++part) {
    render_segments(segments_of(static_cast<Part>(part)), model.mesh, k, camera, alone);
    int covered = 0;  // |A_{t-1} n B_k|
    int still = 0;    // |A_t n B_k|
    for (int y = alone.top; y < alone.bottom; ++y) {
      const auto row = static_cast<std::size_t>(y) * static_cast<std::size_t>(alone.width);
      const auto* labels_before = before.ptr<std::uint8_t>(y);
      const auto* labels_now = now.ptr<std::uint8_t>(y);
      for (int x = alone.left; x < alone.right; ++x) {
        const std::size_t at = row + static_cast<std::size_t>(x);
        const std::uint8_t surface = alone.surface[at];
        if (surface != 0 && alone.inverse_depth[at] >= whole.inverse_depth[at]) {
          covered += labels_before[x] == surface;
          still += labels_now[x] == surface;
        }
      }
    }
    // A part that covers no pixel of its class is not where the pose has it: it counts as moving.
    shares[part] = covered > 0 ? static_cast<double>(covered - still) / covered : 1.0;
  }
  return shares;
}

void find_moving_parts(const FilterContext& context, Generation& generation) {
  if (context.labels_before == nullptr || context.labels_before->size() != context.frame.labels.size()) {
    return;
  }
  const auto shares = uncovered_shares(*context.labels_before, context.frame.labels, context.model,
                                       context.estimate, context.frame.camera);
  PartSet moving;
  for (std::size_t part = 0; part < kPartCount; ++part) {
    moving[part] = shares[part] >= context.numbers.motion[part];
  }
  generation.moving = has(moving, Part::trunk) ? all_parts() : moving;
}

}  // namespace telemime
