// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <initializer_list>
#include <vector>

#include "telemime/body/face_model.h"
#include "telemime/body/skeleton.h"

namespace telemime::testing {

/// The canonical face, moved by known deformations in the head's axes; mm.
struct TestFace {
  FacePoints points = canonical_face();

  using List = std::initializer_list<std::size_t>;

  /// The points of the right side, or their mirror images on the left.
  static std::vector<std::size_t> on(Side side, List right) {
    std::vector<std::size_t> list(right);
    for (std::size_t& i : list) {
      i = side == Side::left ? mirrored(i) : i;
    }
    return list;
  }
  static std::size_t mirrored(std::size_t point) {
    if (point >= kFaceMeshPoints) {
      constexpr std::size_t kMirror[] = {5, 8, 7, 6, 9, 0, 3, 2, 1, 4};  // the edge's points go round
      return kFaceMeshPoints + kMirror[point - kFaceMeshPoints];
    }
    const Eigen::Vector3d image = canonical_face()[point].cwiseProduct(Eigen::Vector3d(-1, 1, 1));
    std::size_t nearest = 0;
    for (std::size_t i = 1; i < kFaceMeshPoints; ++i) {
      if ((canonical_face()[i] - image).norm() < (canonical_face()[nearest] - image).norm()) {
        nearest = i;
      }
    }
    return nearest;
  }
  static Eigen::Vector3d outward(Side side) { return {side == Side::left ? 1.0 : -1.0, 0.0, 0.0}; }

  void move(const std::vector<std::size_t>& list, const Eigen::Vector3d& by) {
    for (const std::size_t i : list) {
      points[i] += by;
    }
  }

  /// Moves the upper lid by this share of the way to the lower one; negative: up.
  void close_eye(Side side, double share) {
    constexpr std::size_t kUpper[] = {246, 161, 160, 159, 158, 157, 173};
    constexpr std::size_t kLower[] = {7, 163, 144, 145, 153, 154, 155};
    for (std::size_t k = 0; k < std::size(kUpper); ++k) {
      Eigen::Vector3d& upper = points[on(side, {kUpper[k]})[0]];
      upper += share * (points[on(side, {kLower[k]})[0]] - upper);
    }
  }
  void raise_lower_lid(Side side, double mm) {
    move(on(side, {7, 163, 144, 145, 153, 154, 155}), {0, -mm, 0});
  }
  /// Turns both eyes: to the person's left, and up; rad.
  void look(double left, double up) {
    for (const std::size_t iris : {kRightIris, kLeftIris}) {
      constexpr double kRadius = 12.0;
      const Eigen::Vector3d ball = canonical_face()[iris] + Eigen::Vector3d(0, 0, kRadius);
      const double y = -kRadius * std::sin(up), x = kRadius * std::sin(left);
      points[iris] = ball + Eigen::Vector3d(x, y, -std::sqrt(kRadius * kRadius - x * x - y * y));
    }
  }
  void brow_inner(Side side, double up) { move(on(side, {107, 66, 55, 65}), {0, -up, 0}); }
  void brow_outer(Side side, double up) { move(on(side, {70, 63, 46, 53}), {0, -up, 0}); }
  std::vector<std::size_t> lower_lip() const {
    std::vector<std::size_t> list = {14, 15, 16, 17};
    for (const Side side : {Side::left, Side::right}) {
      for (const std::size_t i : on(side, {87, 178, 88, 86, 179, 89, 85, 180, 90, 84, 181, 91})) {
        list.push_back(i);
      }
    }
    return list;
  }
  std::vector<std::size_t> upper_lip() const {
    std::vector<std::size_t> list = {0, 11, 12, 13};
    for (const Side side : {Side::left, Side::right}) {
      for (const std::size_t i : upper_lip(side)) {
        list.push_back(i);
      }
    }
    return list;
  }
  static std::vector<std::size_t> upper_lip(Side side) {
    return on(side, {82, 81, 80, 38, 41, 42, 72, 73, 74, 37, 39, 40});
  }
  static std::vector<std::size_t> lower_lip(Side side) {
    return on(side, {87, 178, 88, 86, 179, 89, 85, 180, 90, 84, 181, 91});
  }
  static std::vector<std::size_t> corner(Side side) { return on(side, {61, 62, 76, 78, 185, 146, 57}); }
  static std::vector<std::size_t> chin() {
    std::vector<std::size_t> list = {18, 200, 199, 175, 152};
    for (const Side side : {Side::left, Side::right}) {
      for (const std::size_t i : on(side, {148, 176, 149, 150, 83, 182, 201, 208, 171, 140, 170, 169})) {
        list.push_back(i);
      }
    }
    return list;
  }
  void jaw(const Eigen::Vector3d& by, bool lips_closed = false) {
    move(chin(), by);
    for (const Side side : {Side::left, Side::right}) {
      move(corner(side), 0.3 * Eigen::Vector3d(0, by.y(), 0));
    }
    if (!lips_closed) {
      move(lower_lip(), by);
    }
  }
  void lips(const Eigen::Vector3d& by) {
    move(lower_lip(), by);
    move(upper_lip(), by);
    move(corner(Side::left), by);
    move(corner(Side::right), by);
  }
  /// Width of the mouth, by a factor.
  void narrow(double factor) {
    for (const auto& list : {lower_lip(), upper_lip(), corner(Side::left), corner(Side::right)}) {
      for (const std::size_t i : list) {
        points[i].x() *= factor;
      }
    }
  }
  /// Moves each edge of a lip this share of the way to its inside.
  void thin(const std::vector<std::size_t>& edges, const std::vector<std::size_t>& insides, double share) {
    for (std::size_t k = 0; k < edges.size(); ++k) {
      Eigen::Vector3d& edge = points[edges[k]];
      edge += share * (points[insides[k]] - edge);
    }
  }

  /// In a picture: turned, and `scale` pixels per mm around a pixel.
  FacePoints seen(const Eigen::Quaterniond& rotation, double scale, const Eigen::Vector2d& centre) const {
    FacePoints result;
    for (std::size_t i = 0; i < kFacePoints; ++i) {
      result[i] = scale * (rotation * points[i]) + Eigen::Vector3d(centre.x(), centre.y(), 0.0);
    }
    return result;
  }
};

}  // namespace telemime::testing
