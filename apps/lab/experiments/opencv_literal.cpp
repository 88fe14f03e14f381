// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <map>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "lab/experiments/engine_bench.h"

namespace telemime {
namespace {

// Surfaces with a depth below this (m) are not drawn.
constexpr double kNearest = 0.05;

class LiteralOpencv final : public Backend {
 public:
  std::string_view name() const override { return "opencv, each step its call"; }

  void count(const PreparedFrame& frame, const Model& model, std::span<const Pose> poses, Reduction terms,
             std::span<Reductions> counts) override {
    for (std::size_t i = 0; i < poses.size(); ++i) {
      project(frame.camera, model, forward_kinematics(model.body, poses[i]));
      draw(frame, model.mesh);
      if (wants(terms, Reduction::overlap)) {
        count_overlap(frame, counts[i]);
      }
      if (wants(terms, Reduction::contour)) {
        look_up(frame, counts[i]);
      }
    }
  }

 private:
  void project(const Camera& camera, const Model& model, const Kinematics& kinematics) {
    const cv::Matx33d matrix(camera.fx, 0.0, camera.cx, 0.0, camera.fy, camera.cy, 0.0, 0.0, 1.0);
    pixels_.resize(model.mesh.vertices.size());
    depths_.resize(model.mesh.vertices.size());
    for (std::size_t s = 0; s < kSegmentCount; ++s) {
      const Eigen::Isometry3d& place = kinematics.camera_from_segment[s];
      cv::Matx33d rotation;
      for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) {
          rotation(row, column) = place.linear()(row, column);
        }
      }
      const cv::Vec3d shift(place.translation().x(), place.translation().y(), place.translation().z());
      std::vector<cv::Point3f> points;
      for (auto i = model.mesh.vertex_range[s].begin; i < model.mesh.vertex_range[s].end; ++i) {
        const Eigen::Vector3f& v = model.mesh.vertices[i];
        points.emplace_back(v.x(), v.y(), v.z());
        depths_[i] = (place * v.cast<double>()).z();
      }
      std::vector<cv::Point2f> projected;
      cv::projectPoints(points, rotation, shift, matrix, cv::noArray(), projected);
      std::copy(projected.begin(), projected.end(), pixels_.begin() + model.mesh.vertex_range[s].begin);
    }
  }

  bool faces_camera(const MeshTriangle& triangle) const {
    const auto [a, b, c] = triangle.vertex;
    return depths_[a] >= kNearest && depths_[b] >= kNearest && depths_[c] >= kNearest &&
           (pixels_[b] - pixels_[a]).cross(pixels_[c] - pixels_[a]) < 0.0F;
  }

  static cv::Point rounded(const cv::Point2f& p) { return {cvRound(p.x), cvRound(p.y)}; }

  // From the farthest triangle to the nearest, each over what lies behind it, in the classes' image and in
  // the contour's; then its own edges of the contour.
  void draw(const PreparedFrame& frame, const BodyMesh& mesh) {
    facing_.clear();
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      facing_.push_back(faces_camera(mesh.triangles[t]));
      if (facing_[t]) {
        const auto [a, b, c] = mesh.triangles[t].vertex;
        order.emplace_back(depths_[a] + depths_[b] + depths_[c], t);
      }
    }
    std::multimap<std::size_t, std::array<std::uint32_t, 2>> edges;  // of the triangle that is seen
    for (const MeshEdge& edge : mesh.edges) {
      if (facing_[edge.triangle[0]] != facing_[edge.triangle[1]]) {
        edges.emplace(edge.triangle[facing_[edge.triangle[0]] ? 0 : 1], edge.vertex);
      }
    }
    std::sort(order.rbegin(), order.rend());
    classes_ = cv::Mat::zeros(frame.labels.size(), CV_8UC1);
    contour_ = cv::Mat::zeros(frame.labels.size(), CV_8UC1);
    for (const auto& [depth, t] : order) {
      const auto [a, b, c] = mesh.triangles[t].vertex;
      const std::array<cv::Point, 3> corners = {rounded(pixels_[a]), rounded(pixels_[b]),
                                                rounded(pixels_[c])};
      cv::fillConvexPoly(classes_, corners.data(), 3, static_cast<double>(mesh.triangles[t].surface));
      cv::fillConvexPoly(contour_, corners.data(), 3, 0.0);
      for (auto [edge, end] = edges.equal_range(t); edge != end; ++edge) {
        cv::line(contour_, rounded(pixels_[edge->second[0]]), rounded(pixels_[edge->second[1]]), 255.0);
      }
    }
  }

  // Equation 2.5 with images for sets.
  void count_overlap(const PreparedFrame& frame, Reductions& r) const {
    const cv::Mat known = frame.labels <= static_cast<double>(kSurfaceClassCount);
    for (std::size_t c = 0; c < kSurfaceClassCount; ++c) {
      const auto label = static_cast<double>(c + 1);
      const cv::Mat model = (classes_ == label) & known;
      r.model[c] = cv::countNonZero(model);
      r.both[c] = cv::countNonZero(model & (frame.labels == label));
    }
  }

  void look_up(const PreparedFrame& frame, Reductions& r) const {
    r.contour_points = cv::countNonZero(contour_);
    r.contour_sum = cv::mean(frame.distance, contour_)[0] * r.contour_points;
  }

  std::vector<cv::Point2f> pixels_;
  std::vector<double> depths_;
  std::vector<bool> facing_;  ///< by triangle
  cv::Mat classes_, contour_;
};

}  // namespace

std::unique_ptr<Backend> make_literal_opencv() {
  return std::make_unique<LiteralOpencv>();
}

}  // namespace telemime
