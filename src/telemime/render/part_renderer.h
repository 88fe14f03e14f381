// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "telemime/render/renderer.h"

namespace telemime {

/// Renders poses that share most of their segments: a search over one arm moves three of eight. The segments
/// that stayed are drawn once and kept. Camera, vertices
/// and surfaces are compared in each call, so another mesh of make_mesh() or another camera starts anew.
class PartRenderer {
 public:
  /// What render() gives, but for pixels where two segments are at exactly one depth. Valid until the next
  /// call.
  const Rendering& render(const BodyMesh& mesh, const Kinematics& kinematics, const Camera& camera);

 private:
  void remember(const BodyMesh& mesh, const Camera& camera);
  bool remembered(const BodyMesh& mesh, const Camera& camera) const;

  Rendering rendering_;
  Rendering base_;
  SegmentSet in_base_;  ///< drawn in base_, where base_kinematics_ says; none: there is no base
  Kinematics base_kinematics_;
  std::optional<Kinematics> last_;
  std::vector<Eigen::Vector3f> vertices_;
  std::vector<SurfaceClass> surfaces_;
  Camera camera_;
};

}  // namespace telemime
