// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "telemime/body/arm_ik.h"
#include "telemime/body/testing_poses.h"
#include "telemime/image/edges.h"
#include "telemime/likelihood/backend.h"
#include "telemime/render/renderer.h"

/// A person made of the tracker's own model, as a perfect segmentation would see them.
namespace telemime::support {

inline constexpr double kDistanceCap = 20.0;  ///< px at 160 columns

/// Edges where the class changes or the depth (m) jumps. Not by way of the model's occluding contour, so that
/// a fault there does not cancel out.
inline cv::Mat edges_of(const Rendering& r) {
  constexpr float kJump = 0.015F;
  cv::Mat edges = cv::Mat::zeros(r.height, r.width, CV_8UC1);
  const auto at = [&](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(r.width) + static_cast<std::size_t>(x);
  };
  const auto differ = [&](std::size_t a, std::size_t b) {
    if (r.surface[a] != r.surface[b]) {
      return true;
    }
    return r.surface[a] != 0 && std::abs(1.0F / r.inverse_depth[a] - 1.0F / r.inverse_depth[b]) > kJump;
  };
  for (int y = 0; y + 1 < r.height; ++y) {
    for (int x = 0; x + 1 < r.width; ++x) {
      if (differ(at(x, y), at(x + 1, y)) || differ(at(x, y), at(x, y + 1))) {
        edges.at<std::uint8_t>(y, x) = 255;
      }
    }
  }
  return edges;
}

/// The head from crown to chin (heights of mesh.cpp's head above the neck, m at a stature of 1.70 m).
inline HeadRegion head_of(const Body& body, const Kinematics& k, const Camera& camera) {
  const double size = body.shape.stature / 1.70;
  const SegmentScale& s = body.shape[Segment::head];
  const auto pixel = [&](double x, double y) {
    return camera.project(k[Segment::head] *
                          Eigen::Vector3d(x * size * s.width, y * size * s.length, 0.045 * size * s.height));
  };
  HeadRegion head;
  head.centre = 0.5 * (pixel(0.0, 0.030) + pixel(0.0, 0.271));
  head.radii = {0.5 * (pixel(0.080, 0.15) - pixel(-0.080, 0.15)).norm(),
                0.5 * (pixel(0.0, 0.030) - pixel(0.0, 0.271)).norm()};
  head.detected = true;
  return head;
}

/// A noise-free frame of the model in this pose.
inline FrameFeatures observe(const Model& model, const Pose& pose, const Camera& camera) {
  const Kinematics k = forward_kinematics(model.body, pose);
  Rendering rendering;
  render(model.mesh, k, camera, rendering);
  FrameFeatures seen;
  seen.labels = cv::Mat(camera.height, camera.width, CV_8UC1, rendering.surface.data()).clone();
  seen.silhouette = cv::Mat(seen.labels > 0);
  seen.edges = edges_of(rendering);
  seen.distance =
      distance_map(seen.edges, kDistanceCap * reference_width(camera.width, camera.height) / 160.0);
  seen.head = head_of(model.body, k, camera);
  return seen;
}

/// Both arms; the right one mirrors the angles of the left.
inline Pose seated(const ArmAngles& left, const ArmAngles& right) {
  Pose pose;
  pose.root = {0.0, 0.35, 1.5};
  set_arm_angles(pose, Side::left, left);
  set_arm_angles(pose, Side::right, {right.flexion, -right.twisting, -right.abduct, right.elbow});
  return pose;
}

/// Gestures in which both arms are seen.
inline std::vector<Pose> gestures() {
  using testing_poses::kDegree;
  return {seated({0, 0, 30 * kDegree, -20 * kDegree}, {0, 0, 30 * kDegree, -20 * kDegree}),
          seated({-20 * kDegree, 20 * kDegree, 35 * kDegree, -90 * kDegree},
                 {-30 * kDegree, 10 * kDegree, 20 * kDegree, -70 * kDegree}),
          seated({-60 * kDegree, 0, 40 * kDegree, -50 * kDegree}, {0, 0, 60 * kDegree, -40 * kDegree}),
          seated({-10 * kDegree, 0, 80 * kDegree, -80 * kDegree},
                 {10 * kDegree, 0, 25 * kDegree, -30 * kDegree})};
}

}  // namespace telemime::support
