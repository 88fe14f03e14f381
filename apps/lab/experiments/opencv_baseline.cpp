// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/engine_bench.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <opencv2/imgproc.hpp>

namespace telemime {
namespace {

// Fractional bits of the coordinates that fillConvexPoly() and line() take.
constexpr int kPlaces = 4;
// Marks a pixel of the contour, beside its class.
constexpr int kContour = 0x10;
constexpr int kClasses = 0x0F;
// Surfaces with a depth below this (m) are not drawn.
constexpr double kNearest = 0.05;

class OpencvBaseline final : public Backend {
 public:
  std::string_view name() const override { return "opencv"; }

  void count(const PreparedFrame& frame, const Model& model, std::span<const Pose> poses, Reduction terms,
             std::span<Reductions> counts) override {
    cv::compare(frame.labels, kSurfaceClassCount, known_, cv::CMP_LE);
    for (std::size_t c = 0; c < kSurfaceClassCount; ++c) {
      cv::compare(frame.labels, c + 1, observed_[c], cv::CMP_EQ);
    }
    for (std::size_t i = 0; i < poses.size(); ++i) {
      draw(frame, model, poses[i]);
      if (wants(terms, Reduction::overlap)) {
        count_overlap(counts[i]);
      }
      if (wants(terms, Reduction::contour)) {
        sum_contour(frame, counts[i]);
      }
    }
  }

 private:
  void project(const PreparedFrame& frame, const BodyMesh& mesh, const Kinematics& kinematics) {
    points_.resize(mesh.vertices.size());
    in_front_.resize(mesh.vertices.size());
    for (std::size_t s = 0; s < kSegmentCount; ++s) {
      double depth = 0.0;
      const Range range = mesh.vertex_range[s];
      for (auto i = range.begin; i < range.end; ++i) {
        const Eigen::Vector3d p = kinematics.camera_from_segment[s] * mesh.vertices[i].cast<double>();
        depth += p.z();
        in_front_[i] = p.z() >= kNearest ? 1 : 0;
        if (in_front_[i] != 0) {
          const Eigen::Vector2d pixel = frame.camera.project(p) * (1 << kPlaces);
          points_[i] = {cvRound(pixel.x()), cvRound(pixel.y())};
        }
      }
      depth_[s] = depth / (range.end - range.begin);
    }
  }

  // Counter-clockwise from outside is clockwise in the image, where y points down.
  bool faces_camera(const MeshTriangle& triangle) const {
    const auto [a, b, c] = triangle.vertex;
    if (in_front_[a] == 0 || in_front_[b] == 0 || in_front_[c] == 0) {
      return false;
    }
    return cv::Point2d(points_[b] - points_[a]).cross(cv::Point2d(points_[c] - points_[a])) < 0.0;
  }

  void draw(const PreparedFrame& frame, const Model& model, const Pose& pose) {
    const BodyMesh& mesh = model.mesh;
    project(frame, mesh, forward_kinematics(model.body, pose));
    facing_.resize(mesh.triangles.size());
    std::transform(mesh.triangles.begin(), mesh.triangles.end(), facing_.begin(),
                   [&](const MeshTriangle& t) { return static_cast<char>(faces_camera(t)); });
    std::array<std::size_t, kSegmentCount> order{};
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](auto a, auto b) { return depth_[a] > depth_[b]; });
    plane_.create(frame.labels.size(), CV_8UC1);
    plane_.setTo(0);
    for (const std::size_t s : order) {
      draw_segment(mesh, s);
    }
  }

  void draw_segment(const BodyMesh& mesh, std::size_t s) {
    for (auto i = mesh.triangle_range[s].begin; i < mesh.triangle_range[s].end; ++i) {
      const MeshTriangle& triangle = mesh.triangles[i];
      if (facing_[i] != 0) {
        const std::array<cv::Point, 3> corners = {points_[triangle.vertex[0]], points_[triangle.vertex[1]],
                                                  points_[triangle.vertex[2]]};
        cv::fillConvexPoly(plane_, corners.data(), 3, static_cast<double>(triangle.surface), cv::LINE_8,
                           kPlaces);
      }
    }
    for (auto i = mesh.edge_range[s].begin; i < mesh.edge_range[s].end; ++i) {
      const auto [a, b] = mesh.edges[i].vertex;
      const auto [first, second] = mesh.edges[i].triangle;
      if (facing_[first] != facing_[second] && in_front_[a] != 0 && in_front_[b] != 0) {
        const MeshTriangle& seen = mesh.triangles[facing_[first] != 0 ? first : second];
        cv::line(plane_, points_[a], points_[b], kContour + static_cast<double>(seen.surface), 1, cv::LINE_8,
                 kPlaces);
      }
    }
  }

  void count_overlap(Reductions& r) {
    cv::bitwise_and(plane_, kClasses, classes_);
    for (std::size_t c = 0; c < kSurfaceClassCount; ++c) {
      cv::compare(classes_, c + 1, mask_, cv::CMP_EQ);
      cv::bitwise_and(mask_, known_, both_);
      r.model[c] = cv::countNonZero(both_);
      cv::bitwise_and(mask_, observed_[c], both_);
      r.both[c] = cv::countNonZero(both_);
    }
  }

  void sum_contour(const PreparedFrame& frame, Reductions& r) {
    cv::compare(plane_, kContour, mask_, cv::CMP_GT);
    r.contour_points = cv::countNonZero(mask_);
    r.contour_sum = cv::mean(frame.distance, mask_)[0] * r.contour_points;
  }

  std::vector<cv::Point> points_;  ///< projected vertices
  std::vector<char> in_front_;     ///< by vertex: far enough to be projected
  std::vector<char> facing_;       ///< by triangle
  std::array<double, kSegmentCount> depth_{};
  cv::Mat plane_;  ///< class of each pixel; kContour more on the contour
  cv::Mat known_, classes_, mask_, both_;
  std::array<cv::Mat, kSurfaceClassCount> observed_;
};

}  // namespace

std::unique_ptr<Backend> make_opencv_baseline() {
  return std::make_unique<OpencvBaseline>();
}

}  // namespace telemime
