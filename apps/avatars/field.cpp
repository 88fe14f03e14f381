// SPDX-License-Identifier: Apache-2.0
#include "avatars/surface.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace telemime {
namespace {

// Distance to an ellipse or ellipsoid to first order: the implicit function over the length of its gradient.
double distance_to_ellipse(double scaled, double scaled_twice, double smallest) {
  return scaled_twice < 1e-9 ? -smallest : scaled * (scaled - 1.0) / scaled_twice;
}

// The polynomial minimum: equal to the true one where the two differ by more than `blend`.
double smooth_min(double a, double b, double blend) {
  const double h = std::max(blend - std::abs(a - b), 0.0) / blend;
  return std::min(a, b) - 0.25 * h * h * blend;
}

double smooth_max(double a, double b, double blend) {
  return -smooth_min(-a, -b, blend);
}

// Slope of a curve through three points at the middle one; 0 at the ends.
double slope(double before, double value, double after, double width_before, double width_after) {
  const double left = (value - before) / width_before;
  const double right = (after - value) / width_after;
  // The harmonic mean keeps the curve from swinging past its points (Fritsch and Butland, 1984).
  return left * right <= 0.0 ? 0.0 : 2.0 * left * right / (left + right);
}

struct Loft {
  Eigen::Vector3d origin, along, front, side;
  std::vector<LoftRing> rings;
  std::vector<LoftRing> slopes;

  void find_slopes() {
    slopes.assign(rings.size(), LoftRing{});
    for (std::size_t i = 0; i < rings.size(); ++i) {
      const std::size_t last = rings.size() - 1;
      // At the ends the curve goes on straight.
      const LoftRing& a = i > 0 ? rings[i - 1] : rings[0];
      const LoftRing& c = i < last ? rings[i + 1] : rings[last];
      const LoftRing& b = rings[i];
      const bool inner = i > 0 && i < last;
      const auto of = [&](double LoftRing::*value) {
        return inner ? slope(a.*value, b.*value, c.*value, b.at - a.at, c.at - b.at)
                     : (c.*value - a.*value) / (c.at - a.at);
      };
      slopes[i] = {b.at, of(&LoftRing::centre), of(&LoftRing::radius_side), of(&LoftRing::radius_front)};
    }
  }

  LoftRing ring_at(double t) const {
    std::size_t i = 0;
    while (i + 2 < rings.size() && t > rings[i + 1].at) {
      ++i;
    }
    const LoftRing& a = rings[i];
    const LoftRing& b = rings[i + 1];
    const double width = b.at - a.at;
    const double u = std::clamp((t - a.at) / width, 0.0, 1.0);
    const auto of = [&](double LoftRing::*value) {  // cubic Hermite
      const double rise = u * u * (3.0 - 2.0 * u);
      return a.*value + rise * (b.*value - a.*value) +
             width * u * (1.0 - u) * ((1.0 - u) * slopes[i].*value - u * slopes[i + 1].*value);
    };
    return {t, of(&LoftRing::centre), of(&LoftRing::radius_side), of(&LoftRing::radius_front)};
  }

  double operator()(const Eigen::Vector3d& point) const {
    const Eigen::Vector3d p = point - origin;
    const double t = p.dot(along);
    const LoftRing ring = ring_at(t);
    const double x = p.dot(side) / ring.radius_side;
    const double z = (p.dot(front) - ring.centre) / ring.radius_front;
    const double across =
        distance_to_ellipse(std::hypot(x, z), std::hypot(x / ring.radius_side, z / ring.radius_front),
                            std::min(ring.radius_side, ring.radius_front));
    const double beyond = std::max(rings.front().at - t, t - rings.back().at);
    return std::min(std::max(across, beyond), 0.0) + std::hypot(std::max(across, 0.0), std::max(beyond, 0.0));
  }
};

}  // namespace

Field ellipsoid(const Eigen::Vector3d& centre, const Eigen::Vector3d& radii) {
  return [centre, radii](const Eigen::Vector3d& point) {
    const Eigen::Vector3d scaled = (point - centre).cwiseQuotient(radii);
    return distance_to_ellipse(scaled.norm(), scaled.cwiseQuotient(radii).norm(), radii.minCoeff());
  };
}

Field round_cone(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double radius_a, double radius_b) {
  return [a, axis = Eigen::Vector3d(b - a), radius_a, radius_b](const Eigen::Vector3d& point) {
    const Eigen::Vector3d p = point - a;
    const double t = std::clamp(p.dot(axis) / axis.squaredNorm(), 0.0, 1.0);
    return (p - t * axis).norm() - std::lerp(radius_a, radius_b, t);
  };
}

Field round_box(const Eigen::Vector3d& centre, const Eigen::Vector3d& half, double rounding) {
  const Eigen::Vector3d inner = half.array() - rounding;
  return [centre, inner, rounding](const Eigen::Vector3d& point) {
    const Eigen::Vector3d q = (point - centre).cwiseAbs() - inner;
    return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0) - rounding;
  };
}

Field half_space(const Eigen::Vector3d& point, const Eigen::Vector3d& normal) {
  return [point, normal](const Eigen::Vector3d& p) { return (p - point).dot(normal); };
}

Field loft(const Eigen::Vector3d& origin, const Eigen::Vector3d& along, const Eigen::Vector3d& front,
           std::vector<LoftRing> rings) {
  Loft result{origin, along, front, along.cross(front), std::move(rings), {}};
  result.find_slopes();
  return result;
}

Field blended(std::vector<Field> fields, double blend) {
  return [fields = std::move(fields), blend](const Eigen::Vector3d& point) {
    double value = fields.front()(point);
    for (std::size_t i = 1; i < fields.size(); ++i) {
      value = smooth_min(value, fields[i](point), blend);
    }
    return value;
  };
}

Field overlap(Field a, Field b, double rounding) {
  return [a = std::move(a), b = std::move(b), rounding](const Eigen::Vector3d& point) {
    return smooth_max(a(point), b(point), rounding);
  };
}

Field without(Field a, Field b, double rounding) {
  return [a = std::move(a), b = std::move(b), rounding](const Eigen::Vector3d& point) {
    return smooth_max(a(point), -b(point), rounding);
  };
}

Field seam(Field a, Field b, double radius) {
  return [a = std::move(a), b = std::move(b), radius](const Eigen::Vector3d& point) {
    return std::hypot(a(point), b(point)) - radius;
  };
}

Field grown(Field a, double distance) {
  return [a = std::move(a), distance](const Eigen::Vector3d& point) { return a(point) - distance; };
}

Field mirror_x(Field a) {
  return [a = std::move(a)](const Eigen::Vector3d& point) {
    return a(Eigen::Vector3d(std::abs(point.x()), point.y(), point.z()));
  };
}

Eigen::Vector3d outward(const Field& field, const Eigen::Vector3d& point, double step) {
  Eigen::Vector3d gradient;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d d = step * Eigen::Vector3d::Unit(axis);
    gradient[axis] = field(point + d) - field(point - d);
  }
  const double length = gradient.norm();
  return length > 0.0 ? Eigen::Vector3d(gradient / length) : Eigen::Vector3d(Eigen::Vector3d::UnitY());
}

}  // namespace telemime
