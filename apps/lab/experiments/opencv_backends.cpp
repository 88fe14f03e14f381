// SPDX-License-Identifier: Apache-2.0
// The evaluation with OpenCV: step by step as the thesis describes it, and the same optimised for speed.
#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "lab/experiments/engine.h"

namespace telemime {
namespace {

// Surfaces with a depth below this (m) are not drawn.
constexpr double kNearest = 0.05;

// What both have in common: `Point` is a projected vertex.
template <typename Point>
class OpencvBackend : public Backend {
 public:
  void count(const PreparedFrame& frame, const Model& model, std::span<const Pose> poses,
             std::span<const Kinematics>, Reduction terms, std::span<Reductions> counts) override {
    for (std::size_t i = 0; i < poses.size(); ++i) {
      draw(frame, model, forward_kinematics(model.body, poses[i]));
      if (wants(terms, Reduction::overlap)) {
        count_overlap(frame, counts[i]);
      }
      if (wants(terms, Reduction::contour)) {
        const cv::Mat& mask = contour_mask();
        counts[i].contour_points = cv::countNonZero(mask);
        counts[i].contour_sum = cv::mean(frame.distance, mask)[0] * counts[i].contour_points;
      }
    }
  }

 protected:
  virtual void draw(const PreparedFrame& frame, const Model& model, const Kinematics& kinematics) = 0;
  virtual void count_overlap(const PreparedFrame& frame, Reductions& r) = 0;
  virtual const cv::Mat& contour_mask() = 0;  // of the drawn model

  // Counter-clockwise from outside is clockwise in the image, where y points down.
  void find_facing(const BodyMesh& mesh) {
    facing_.resize(mesh.triangles.size());
    std::transform(mesh.triangles.begin(), mesh.triangles.end(), facing_.begin(), [&](const MeshTriangle& t) {
      const auto [a, b, c] = t.vertex;
      return std::min({depths_[a], depths_[b], depths_[c]}) >= kNearest &&
             cv::Point2d(points_[b] - points_[a]).cross(cv::Point2d(points_[c] - points_[a])) < 0.0;
    });
  }
  // The triangle beside an edge of the contour that is seen; none where both or neither face the camera.
  std::optional<std::size_t> seen_beside(const MeshEdge& edge) const {
    const auto [first, second] = edge.triangle;
    return facing_[first] == facing_[second] ? std::nullopt
                                             : std::optional<std::size_t>(facing_[first] ? first : second);
  }

  std::vector<Point> points_;   ///< projected vertices
  std::vector<double> depths_;  ///< of the vertices, m
  std::vector<bool> facing_;    ///< by triangle
};

class LiteralOpencv final : public OpencvBackend<cv::Point2f> {
 public:
  std::string_view name() const override { return "opencv, each step its call"; }

 private:
  void project(const Camera& camera, const Model& model, const Kinematics& kinematics) {
    const cv::Matx33d matrix(camera.fx, 0.0, camera.cx, 0.0, camera.fy, camera.cy, 0.0, 0.0, 1.0);
    points_.resize(model.mesh.vertices.size());
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
      std::vector<cv::Point3f> vertices;
      for (auto i = model.mesh.vertex_range[s].begin; i < model.mesh.vertex_range[s].end; ++i) {
        const Eigen::Vector3f& v = model.mesh.vertices[i];
        vertices.emplace_back(v.x(), v.y(), v.z());
        depths_[i] = (place * v.cast<double>()).z();
      }
      std::vector<cv::Point2f> projected;
      cv::projectPoints(vertices, rotation, shift, matrix, cv::noArray(), projected);
      std::copy(projected.begin(), projected.end(), points_.begin() + model.mesh.vertex_range[s].begin);
    }
  }

  cv::Point pixel(std::size_t vertex) const {
    return {cvRound(points_[vertex].x), cvRound(points_[vertex].y)};
  }

  // From the farthest triangle to the nearest, each over what lies behind it, in the classes' image and in
  // the contour's; then its own edges of the contour.
  void draw(const PreparedFrame& frame, const Model& model, const Kinematics& kinematics) override {
    project(frame.camera, model, kinematics);
    const BodyMesh& mesh = model.mesh;
    find_facing(mesh);
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      if (facing_[t]) {
        const auto [a, b, c] = mesh.triangles[t].vertex;
        order.emplace_back(depths_[a] + depths_[b] + depths_[c], t);
      }
    }
    std::multimap<std::size_t, std::array<std::uint32_t, 2>> edges;  // of the triangle that is seen
    for (const MeshEdge& edge : mesh.edges) {
      if (const auto seen = seen_beside(edge)) {
        edges.emplace(*seen, edge.vertex);
      }
    }
    std::sort(order.rbegin(), order.rend());
    classes_ = cv::Mat::zeros(frame.labels.size(), CV_8UC1);
    contour_ = cv::Mat::zeros(frame.labels.size(), CV_8UC1);
    for (const auto& [depth, t] : order) {
      const auto [a, b, c] = mesh.triangles[t].vertex;
      const std::array<cv::Point, 3> corners = {pixel(a), pixel(b), pixel(c)};
      cv::fillConvexPoly(classes_, corners.data(), 3, static_cast<double>(mesh.triangles[t].surface));
      cv::fillConvexPoly(contour_, corners.data(), 3, 0.0);
      for (auto [edge, end] = edges.equal_range(t); edge != end; ++edge) {
        cv::line(contour_, pixel(edge->second[0]), pixel(edge->second[1]), 255.0);
      }
    }
  }

  // Equation 2.5 with images for sets.
  void count_overlap(const PreparedFrame& frame, Reductions& r) override {
    const cv::Mat known = frame.labels <= static_cast<double>(kSurfaceClassCount);
    for (std::size_t c = 0; c < kSurfaceClassCount; ++c) {
      const auto label = static_cast<double>(c + 1);
      const cv::Mat model = (classes_ == label) & known;
      r.model[c] = cv::countNonZero(model);
      r.both[c] = cv::countNonZero(model & (frame.labels == label));
    }
  }

  const cv::Mat& contour_mask() override { return contour_; }

  cv::Mat classes_, contour_;
};

// Vertices are pixels with fractional bits, as fillConvexPoly() and line() take them.
class FastOpencv final : public OpencvBackend<cv::Point> {
 public:
  std::string_view name() const override { return "opencv"; }

  void count(const PreparedFrame& frame, const Model& model, std::span<const Pose> poses,
             std::span<const Kinematics>, Reduction terms, std::span<Reductions> counts) override {
    cv::compare(frame.labels, kSurfaceClassCount, known_, cv::CMP_LE);
    for (std::size_t c = 0; c < kSurfaceClassCount; ++c) {
      cv::compare(frame.labels, c + 1, observed_[c], cv::CMP_EQ);
    }
    OpencvBackend::count(frame, model, poses, {}, terms, counts);
  }

 private:
  static constexpr int kPlaces = 4;      // fractional bits
  static constexpr int kContour = 0x10;  // marks a pixel of the contour, beside its class
  static constexpr int kClasses = 0x0F;

  void project(const PreparedFrame& frame, const BodyMesh& mesh, const Kinematics& kinematics) {
    points_.resize(mesh.vertices.size());
    depths_.resize(mesh.vertices.size());
    for (std::size_t s = 0; s < kSegmentCount; ++s) {
      double depth = 0.0;
      const Range range = mesh.vertex_range[s];
      for (auto i = range.begin; i < range.end; ++i) {
        const Eigen::Vector3d p = kinematics.camera_from_segment[s] * mesh.vertices[i].cast<double>();
        depth += p.z();
        depths_[i] = p.z();
        if (p.z() >= kNearest) {
          const Eigen::Vector2d pixel = frame.camera.project(p) * (1 << kPlaces);
          points_[i] = {cvRound(pixel.x()), cvRound(pixel.y())};
        }
      }
      depth_[s] = depth / (range.end - range.begin);
    }
  }

  void draw(const PreparedFrame& frame, const Model& model, const Kinematics& kinematics) override {
    project(frame, model.mesh, kinematics);
    find_facing(model.mesh);
    std::array<std::size_t, kSegmentCount> order{};
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](auto a, auto b) { return depth_[a] > depth_[b]; });
    plane_.create(frame.labels.size(), CV_8UC1);
    plane_.setTo(0);
    for (const std::size_t s : order) {
      draw_segment(model.mesh, s);
    }
  }

  void draw_segment(const BodyMesh& mesh, std::size_t s) {
    for (auto i = mesh.triangle_range[s].begin; i < mesh.triangle_range[s].end; ++i) {
      if (facing_[i]) {
        const auto [a, b, c] = mesh.triangles[i].vertex;
        const std::array<cv::Point, 3> corners = {points_[a], points_[b], points_[c]};
        cv::fillConvexPoly(plane_, corners.data(), 3, static_cast<double>(mesh.triangles[i].surface),
                           cv::LINE_8, kPlaces);
      }
    }
    for (auto i = mesh.edge_range[s].begin; i < mesh.edge_range[s].end; ++i) {
      if (const auto seen = seen_beside(mesh.edges[i])) {
        const auto [a, b] = mesh.edges[i].vertex;
        cv::line(plane_, points_[a], points_[b],
                 kContour + static_cast<double>(mesh.triangles[*seen].surface), 1, cv::LINE_8, kPlaces);
      }
    }
  }

  void count_overlap(const PreparedFrame&, Reductions& r) override {
    cv::bitwise_and(plane_, kClasses, classes_);
    for (std::size_t c = 0; c < kSurfaceClassCount; ++c) {
      cv::compare(classes_, c + 1, mask_, cv::CMP_EQ);
      cv::bitwise_and(mask_, known_, both_);
      r.model[c] = cv::countNonZero(both_);
      cv::bitwise_and(mask_, observed_[c], both_);
      r.both[c] = cv::countNonZero(both_);
    }
  }

  const cv::Mat& contour_mask() override {
    cv::compare(plane_, kContour, mask_, cv::CMP_GT);
    return mask_;
  }

  std::array<double, kSegmentCount> depth_{};  ///< mean of the segment's vertices, m
  cv::Mat plane_;                              ///< class of each pixel; kContour more on the contour
  cv::Mat known_, classes_, mask_, both_;
  std::array<cv::Mat, kSurfaceClassCount> observed_;
};

}  // namespace

std::unique_ptr<Backend> make_literal_opencv() {
  return std::make_unique<LiteralOpencv>();
}

std::unique_ptr<Backend> make_fast_opencv() {
  return std::make_unique<FastOpencv>();
}

}  // namespace telemime
