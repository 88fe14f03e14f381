// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include "avatars/tailor.h"

namespace telemime {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr Colour kWhite = 0xFFFFFF;
constexpr Colour kDark = 0x1B1512;
constexpr double kBrightness = 255.0;

// Places on the face are (x, y) from the head's joint, m of a head of the default size; x to the person's
// left.
struct Face {
  const Figure& figure;
  Field ground;
  std::vector<AvatarPart> parts;

  /// On the head, seen from the front, `lift` above it.
  Vector3d on(const Vector2d& place, double lift) const {
    Vector3d p = figure.in_head(place.x(), place.y(), 0.25);
    const double target = lift * figure.head_size();
    for (int step = 0; step < 60; ++step) {
      p.z() -= 0.7 * (ground(p) - target);
    }
    return p;
  }

  struct Style {
    const char* name;
    Colour colour;
    double roughness;
    double lift;
    bool glows = false;
  };
  using Outline = std::function<Vector2d(double, double)>;  ///< of u and v in [0, 1]
  using Closed = std::function<Vector2d(const Vector2d&)>;  ///< where a place goes when the eye closes

  /// A sheet of columns x rows quads. Mirrored on the other side, where asked.
  void add(const Style& style, int columns, int rows, const Outline& outline, const Closed& closed,
           bool pair) {
    Triangles sheet;
    std::vector<Vector3d> blink;
    for (int row = 0; row <= rows; ++row) {
      for (int column = 0; column <= columns; ++column) {
        const Vector2d place =
            outline(static_cast<double>(column) / columns, static_cast<double>(row) / rows);
        const Vector3d p = on(place, style.lift);
        sheet.vertices.push_back(p);
        sheet.normals.push_back(outward(ground, p, 0.002));
        blink.push_back(on(closed(place), style.lift) - p);
      }
    }
    const auto at = [&](int column, int row) {
      return static_cast<std::uint32_t>(row * (columns + 1) + column);
    };
    for (int row = 0; row < rows; ++row) {
      for (int column = 0; column < columns; ++column) {
        sheet.triangles.push_back({at(column, row), at(column + 1, row), at(column + 1, row + 1)});
        sheet.triangles.push_back({at(column, row), at(column + 1, row + 1), at(column, row + 1)});
      }
    }
    if (pair) {
      append(sheet, mirrored_x(sheet));
      for (std::size_t i = 0, n = blink.size(); i < n; ++i) {
        blink.emplace_back(-blink[i].x(), blink[i].y(), blink[i].z());
      }
    }
    const auto same =
        std::find_if(parts.begin(), parts.end(), [&](const AvatarPart& p) { return p.name == style.name; });
    if (same == parts.end()) {
      parts.push_back(
          {style.name, style.colour, style.roughness, std::move(sheet), style.glows, std::move(blink)});
      return;
    }
    append(same->surface, sheet);
    same->blink.insert(same->blink.end(), blink.begin(), blink.end());
  }
};

// A filled ellipse: the square mapped to the disc (Shirley and Chiu, 1997).
Face::Outline disc(const Vector2d& centre, const Vector2d& radii) {
  return [=](double u, double v) -> Vector2d {
    const double a = 2.0 * u - 1.0;
    const double b = 2.0 * v - 1.0;
    const double r = std::max(std::abs(a), std::abs(b));
    if (r == 0.0) {
      return centre;
    }
    constexpr double kEighth = std::numbers::pi / 4.0;
    const double angle = std::abs(a) > std::abs(b)
                             ? kEighth * b / a + (a < 0.0 ? std::numbers::pi : 0.0)
                             : 2.0 * kEighth - kEighth * a / b + (b < 0.0 ? std::numbers::pi : 0.0);
    return centre + r * radii.cwiseProduct(Vector2d(std::cos(angle), std::sin(angle)));
  };
}

// A stroke along the arc from `left` to `right` whose middle is `rise` higher, thickest in the middle.
Face::Outline stroke(const Vector2d& left, const Vector2d& right, double rise, double thickness) {
  return [=](double u, double v) -> Vector2d {
    const double bow = 4.0 * u * (1.0 - u);
    const Vector2d middle = left + u * (right - left) + Vector2d(0.0, rise * bow);
    return middle + Vector2d(0.0, (v - 0.5) * thickness * (0.25 + 0.75 * std::sqrt(bow)));
  };
}

Vector2d stays(const Vector2d& place) {
  return place;
}

Colour mixed(Colour a, Colour b, double share) {
  Colour result = 0;
  for (const unsigned shift : {16U, 8U, 0U}) {
    const double from = static_cast<double>((a >> shift) & 0xFFU) / kBrightness;
    const double to = static_cast<double>((b >> shift) & 0xFFU) / kBrightness;
    result |= static_cast<Colour>(std::lround(std::lerp(from, to, share) * kBrightness)) << shift;
  }
  return result;
}

void add_human_face(Face& face, const AvatarLook& look) {
  const Vector2d eye(0.0315, 0.036);
  const Vector2d white(0.0150, 0.0135);
  // Eyes close to the arc of the lashes, which comes down: a smiling blink.
  constexpr double kLash = 0.0128;
  constexpr double kDown = 0.0125;
  const Face::Closed lowered = [=](const Vector2d& p) { return Vector2d(p.x(), p.y() - kDown); };
  const Face::Closed closed = [=](const Vector2d& p) {
    const double out = (std::abs(p.x()) - eye.x()) / 0.0165;
    return Vector2d(p.x(), eye.y() + 0.0020 + kLash * (1.0 - out * out) - kDown + 0.02 * (p.y() - eye.y()));
  };
  face.add({"eye_white", kWhite, 0.35, 0.0006}, 10, 10, disc(eye, white), closed, true);
  const Vector2d iris = eye + Vector2d(-0.0008, -0.0004);
  face.add({"iris", look.eyes, 0.3, 0.0011}, 10, 10, disc(iris, {0.0100, 0.0116}), closed, true);
  face.add({"pupil", kDark, 0.3, 0.0016}, 8, 8, disc(iris, {0.0056, 0.0068}), closed, true);
  // The light comes from the same side in both eyes.
  for (const double side : {1.0, -1.0}) {
    const Vector2d spark = Vector2d(side * iris.x(), iris.y()) + Vector2d(0.0032, 0.0042);
    face.add({"spark", kWhite, 0.2, 0.0021, true}, 6, 6, disc(spark, {0.0025, 0.0028}), closed, false);
  }
  face.add({"lashes", mixed(look.hair, kDark, 0.7), 0.6, 0.0024}, 14, 2,
           stroke(eye + Vector2d(-0.0150, 0.0010), eye + Vector2d(0.0172, 0.0030), kLash, 0.0042), lowered,
           true);
  face.add({"brows", mixed(look.hair, kDark, 0.25), 0.8, 0.0012}, 12, 2,
           stroke({0.0160, 0.0655}, {0.0475, 0.0635}, 0.0060, 0.0058), stays, true);
  face.add({"mouth", mixed(look.skin, 0x7A1F26, 0.72), 0.5, 0.0008}, 16, 2,
           stroke({-0.0215, -0.0215}, {0.0215, -0.0215}, -0.0085, 0.0046), stays, false);
  face.add({"cheeks", mixed(look.skin, 0xE0605A, 0.13), 0.62, 0.0006}, 8, 8,
           disc({0.0455, 0.0040}, {0.0105, 0.0068}), stays, true);
}

void add_robot_face(Face& face, const AvatarLook& look) {
  const Vector2d eye(0.0300, 0.036);
  const Face::Closed closed = [=](const Vector2d& p) {
    return Vector2d(p.x(), eye.y() + 0.10 * (p.y() - eye.y()));
  };
  face.add({"eyes", look.eyes, 0.4, 0.0010, true}, 10, 10, disc(eye, {0.0115, 0.0165}), closed, true);
  face.add({"eyes", look.eyes, 0.4, 0.0010, true}, 14, 2,
           stroke({-0.018, 0.004}, {0.018, 0.004}, -0.0075, 0.0045), stays, false);
}

}  // namespace

std::vector<AvatarPart> make_face(const Figure& figure, const AvatarLook& look) {
  if (look.top_style == TopStyle::shell) {
    Face face{figure, robot_visor(figure), {}};
    add_robot_face(face, look);
    return std::move(face.parts);
  }
  Face face{figure, figure.head, {}};
  add_human_face(face, look);
  return std::move(face.parts);
}

}  // namespace telemime
