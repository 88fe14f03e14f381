// SPDX-License-Identifier: Apache-2.0
#include "avatars/surface.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace telemime {
namespace {

constexpr int kBlock = 8;       // cells along the side of a block that is looked at as a whole first
constexpr double kSlack = 2.0;  // by which a field may overstate distances

// The field on the corners of a grid. Blocks that the surface cannot cross are not looked at.
class Grid {
 public:
  Grid(const Field& field, const Eigen::AlignedBox3d& box, double cell)
      : field_(field),
        cell_(cell),
        size_((box.sizes() / (cell * kBlock)).array().ceil().cast<int>() * kBlock + 1),
        // In the middle of the box, so that a symmetric solid has a symmetric surface.
        origin_(box.center() - 0.5 * cell * (size_.array() - 1).cast<double>().matrix()),
        values_(static_cast<std::size_t>(size_.x()) * static_cast<std::size_t>(size_.y()) *
                static_cast<std::size_t>(size_.z())) {
    Eigen::Vector3i block;
    for (block.z() = 0; block.z() < size_.z(); block.z() += kBlock) {
      for (block.y() = 0; block.y() < size_.y(); block.y() += kBlock) {
        for (block.x() = 0; block.x() < size_.x(); block.x() += kBlock) {
          fill(block);
        }
      }
    }
  }

  const Eigen::Vector3i& size() const { return size_; }
  std::size_t index(const Eigen::Vector3i& c) const {
    return static_cast<std::size_t>(c.x()) +
           static_cast<std::size_t>(size_.x()) *
               (static_cast<std::size_t>(c.y()) +
                static_cast<std::size_t>(size_.y()) * static_cast<std::size_t>(c.z()));
  }
  double operator[](const Eigen::Vector3i& corner) const { return values_[index(corner)]; }
  Eigen::Vector3d place(const Eigen::Vector3d& corner) const { return origin_ + cell_ * corner; }

 private:
  void fill(const Eigen::Vector3i& block) {
    const Eigen::Vector3d middle = place(block.cast<double>().array() + 0.5 * kBlock);
    const double value = field_(middle);
    const bool crossed = std::abs(value) < kSlack * cell_ * 0.5 * std::sqrt(3.0) * (kBlock + 1);
    const Eigen::Vector3i end = (block.array() + kBlock).matrix().cwiseMin(size_);
    Eigen::Vector3i c;
    for (c.z() = block.z(); c.z() < end.z(); ++c.z()) {
      for (c.y() = block.y(); c.y() < end.y(); ++c.y()) {
        for (c.x() = block.x(); c.x() < end.x(); ++c.x()) {
          values_[index(c)] = static_cast<float>(crossed ? field_(place(c.cast<double>())) : value);
        }
      }
    }
  }

  const Field& field_;
  double cell_;
  Eigen::Vector3i size_;
  Eigen::Vector3d origin_;
  std::vector<float> values_;
};

Eigen::Vector3i corner_of(const Eigen::Vector3i& cell, int corner) {
  return cell + Eigen::Vector3i(corner & 1, (corner >> 1) & 1, corner >> 2);
}

// The mean of the points where the surface crosses the cell's edges, in units of the grid.
std::optional<Eigen::Vector3d> crossing(const Grid& grid, const Eigen::Vector3i& cell) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int count = 0;
  for (int corner = 0; corner < 8; ++corner) {
    for (const int bit : {1, 2, 4}) {
      if ((corner & bit) != 0) {
        continue;
      }
      const Eigen::Vector3i a = corner_of(cell, corner);
      const Eigen::Vector3i b = corner_of(cell, corner | bit);
      const double va = grid[a];
      const double vb = grid[b];
      if ((va < 0.0) != (vb < 0.0)) {
        sum += a.cast<double>() + va / (va - vb) * (b - a).cast<double>();
        ++count;
      }
    }
  }
  return count > 0 ? std::optional<Eigen::Vector3d>(sum / count) : std::nullopt;
}

Eigen::Vector3d onto_surface(const Field& field, Eigen::Vector3d point, double cell) {
  for (int step = 0; step < 3; ++step) {
    const double value = std::clamp(field(point), -0.5 * cell, 0.5 * cell);
    point -= 0.9 * value * outward(field, point, 0.05 * cell);
  }
  return point;
}

// Two triangles, cut along the shorter diagonal.
void add_quad(Triangles& surface, std::array<std::uint32_t, 4> q) {
  const auto length = [&](std::size_t a, std::size_t b) {
    return (surface.vertices[q[a]] - surface.vertices[q[b]]).squaredNorm();
  };
  if (length(1, 3) < length(0, 2)) {
    std::rotate(q.begin(), q.begin() + 1, q.end());
  }
  surface.triangles.push_back({q[0], q[1], q[2]});
  surface.triangles.push_back({q[0], q[2], q[3]});
}

}  // namespace

void append(Triangles& surface, const Triangles& more) {
  const auto first = static_cast<std::uint32_t>(surface.vertices.size());
  surface.vertices.insert(surface.vertices.end(), more.vertices.begin(), more.vertices.end());
  surface.normals.insert(surface.normals.end(), more.normals.begin(), more.normals.end());
  for (const auto& t : more.triangles) {
    surface.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
}

Triangles mirrored_x(Triangles surface) {
  for (Eigen::Vector3d& v : surface.vertices) {
    v.x() = -v.x();
  }
  for (Eigen::Vector3d& n : surface.normals) {
    n.x() = -n.x();
  }
  for (auto& t : surface.triangles) {
    std::swap(t[1], t[2]);
  }
  return surface;
}

Triangles surface_of(const Field& field, const Eigen::AlignedBox3d& box, double cell) {
  const Grid grid(field, box, cell);
  const Eigen::Vector3i cells = grid.size().array() - 1;
  std::vector<std::uint32_t> vertex_of(grid.index(grid.size().array() - 1) + 1);
  Triangles surface;
  Eigen::Vector3i c;
  for (c.z() = 0; c.z() < cells.z(); ++c.z()) {
    for (c.y() = 0; c.y() < cells.y(); ++c.y()) {
      for (c.x() = 0; c.x() < cells.x(); ++c.x()) {
        if (const auto found = crossing(grid, c)) {
          vertex_of[grid.index(c)] = static_cast<std::uint32_t>(surface.vertices.size());
          const Eigen::Vector3d point = onto_surface(field, grid.place(*found), cell);
          surface.vertices.push_back(point);
          surface.normals.push_back(outward(field, point, 0.25 * cell));
        }
      }
    }
  }
  // Every edge of the grid that the surface crosses has a face, whose corners are in the four cells about it.
  for (c.z() = 1; c.z() < cells.z(); ++c.z()) {
    for (c.y() = 1; c.y() < cells.y(); ++c.y()) {
      for (c.x() = 1; c.x() < cells.x(); ++c.x()) {
        for (int axis = 0; axis < 3; ++axis) {
          const Eigen::Vector3i along = Eigen::Vector3i::Unit(axis);
          const bool inside = grid[c] < 0.0;
          if (inside == (grid[c + along] < 0.0)) {
            continue;
          }
          const Eigen::Vector3i u = Eigen::Vector3i::Unit((axis + 1) % 3);
          const Eigen::Vector3i v = Eigen::Vector3i::Unit((axis + 2) % 3);
          std::array<std::uint32_t, 4> quad = {vertex_of[grid.index(c - u - v)], vertex_of[grid.index(c - v)],
                                               vertex_of[grid.index(c)], vertex_of[grid.index(c - u)]};
          if (!inside) {
            std::swap(quad[1], quad[3]);
          }
          add_quad(surface, quad);
        }
      }
    }
  }
  return surface;
}

}  // namespace telemime
