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
  /// Where a place with these u and v goes in a shape; x is signed.
  using Move = std::function<Vector2d(FaceShape, const Vector2d&, const Vector2d&)>;

  /// A sheet of columns x rows quads. Mirrored on the other side, where asked.
  void add(const Style& style, int columns, int rows, const Outline& outline, const Move& move, bool pair) {
    auto part =
        std::find_if(parts.begin(), parts.end(), [&](const AvatarPart& p) { return p.name == style.name; });
    if (part == parts.end()) {
      part = parts.insert(part, {style.name, style.colour, style.roughness, {}, style.glows});
    }
    for (const double side : pair ? std::vector{1.0, -1.0} : std::vector{1.0}) {
      Triangles sheet;
      for (int row = 0; row <= rows; ++row) {
        for (int column = 0; column <= columns; ++column) {
          const Vector2d uv(static_cast<double>(column) / columns, static_cast<double>(row) / rows);
          const Vector2d place = outline(uv.x(), uv.y()).cwiseProduct(Vector2d(side, 1.0));
          const Vector3d p = on(place, style.lift);
          sheet.vertices.push_back(p);
          sheet.normals.push_back(outward(ground, p, 0.002));
          for (std::size_t shape = 0; shape < kFaceShapeCount; ++shape) {
            const Vector2d moved = move(static_cast<FaceShape>(shape), place, uv);
            part->moved[shape].push_back(moved == place ? Vector3d(0, 0, 0) : on(moved, style.lift) - p);
          }
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
      if (side < 0.0) {  // seen from the front as those of the other side
        for (auto& triangle : sheet.triangles) {
          std::swap(triangle[1], triangle[2]);
        }
      }
      append(part->surface, sheet);
    }
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

// A mouth: half its width, how much higher its middle is than its corners, how far it is open, and its place.
struct MouthForm {
  double width, rise, open, y;
};

MouthForm mouth_form(FaceShape shape, const MouthForm& rest) {
  switch (shape) {
    case FaceShape::aa:
      return {0.0165, -0.0040, 0.0220, -0.0240};
    case FaceShape::ih:
      return {0.0200, -0.0040, 0.0080, -0.0220};
    case FaceShape::ou:
      return {0.0075, 0.0, 0.0080, -0.0240};
    case FaceShape::ee:
      return {0.0235, -0.0060, 0.0090, -0.0220};
    case FaceShape::oh:
      return {0.0110, 0.0, 0.0170, -0.0240};
    case FaceShape::happy:
      return {0.0245, -0.0135, 0.0040, -0.0190};
    case FaceShape::angry:
      return {0.0175, 0.0040, 0.0, -0.0250};
    case FaceShape::sad:
      return {0.0190, 0.0070, 0.0, -0.0285};
    case FaceShape::relaxed:
      return {0.0230, -0.0110, 0.0, -0.0200};
    case FaceShape::surprised:
      return {0.0100, 0.0, 0.0140, -0.0250};
    default:
      return rest;
  }
}

// A stroke that can open to an ellipse.
Vector2d mouth_place(const MouthForm& form, double thickness, double u, double v) {
  const double bow = 4.0 * u * (1.0 - u);
  const double height = thickness * (0.25 + 0.75 * std::sqrt(bow)) + form.open * std::sqrt(bow);
  return {(2.0 * u - 1.0) * form.width, form.y + form.rise * bow + (v - 0.5) * height};
}

// Direction of the gaze, up and to the person's left, as a share of the largest turn of the eyes.
Vector2d look_of(FaceShape shape) {
  switch (shape) {
    case FaceShape::look_up:
      return {0.0, 1.0};
    case FaceShape::look_down:
      return {0.0, -1.0};
    case FaceShape::look_left:
      return {1.0, 0.0};
    case FaceShape::look_right:
      return {-1.0, 0.0};
    default:
      return {0.0, 0.0};
  }
}

// The brow at a share of its length from the inner end, higher than at rest.
double brow_rise(FaceShape shape, double t) {
  switch (shape) {
    case FaceShape::angry:
      return -0.0075 + 0.0065 * t;
    case FaceShape::sad:
      return 0.0060 - 0.0085 * t;
    case FaceShape::surprised:
      return 0.0085;
    case FaceShape::happy:
      return 0.0020;
    default:
      return 0.0;
  }
}

bool closes(FaceShape shape, double x) {
  return (shape == FaceShape::blink_left && x >= 0.0) || (shape == FaceShape::blink_right && x < 0.0);
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
  const Vector2d turn(0.0036, 0.0028);
  const Face::Move lashes = [=](FaceShape shape, const Vector2d& p, const Vector2d& /*uv*/) -> Vector2d {
    const double up = shape == FaceShape::surprised ? 0.0025 : closes(shape, p.x()) ? -kDown : 0.0;
    return p + Vector2d(0.0, up);
  };
  const Face::Move ball = [=](FaceShape shape, const Vector2d& p, const Vector2d& /*uv*/) -> Vector2d {
    if (!closes(shape, p.x())) {
      return p;
    }
    const double out = (std::abs(p.x()) - eye.x()) / 0.0165;
    return {p.x(), eye.y() + 0.0020 + kLash * (1.0 - out * out) - kDown + 0.02 * (p.y() - eye.y())};
  };
  const Face::Move turning = [=](FaceShape shape, const Vector2d& p, const Vector2d& uv) -> Vector2d {
    return ball(shape, p, uv) + turn.cwiseProduct(look_of(shape));
  };
  face.add({"eye_white", kWhite, 0.35, 0.0006}, 10, 10, disc(eye, white), ball, true);
  const Vector2d iris = eye + Vector2d(-0.0008, -0.0004);
  face.add({"iris", look.eyes, 0.3, 0.0011}, 10, 10, disc(iris, {0.0100, 0.0116}), turning, true);
  face.add({"pupil", kDark, 0.3, 0.0016}, 8, 8, disc(iris, {0.0056, 0.0068}), turning, true);
  // The light comes from the same side in both eyes.
  for (const double side : {1.0, -1.0}) {
    const Vector2d spark = Vector2d(side * iris.x(), iris.y()) + Vector2d(0.0032, 0.0042);
    face.add({"spark", kWhite, 0.2, 0.0021, true}, 6, 6, disc(spark, {0.0025, 0.0028}), turning, false);
  }
  face.add({"lashes", mixed(look.hair, kDark, 0.7), 0.6, 0.0024}, 14, 2,
           stroke(eye + Vector2d(-0.0150, 0.0010), eye + Vector2d(0.0172, 0.0030), kLash, 0.0042), lashes,
           true);
  const Vector2d brow_inner(0.0160, 0.0655), brow_outer(0.0475, 0.0635);
  const Face::Move brows = [=](FaceShape shape, const Vector2d& p, const Vector2d& uv) -> Vector2d {
    return p + Vector2d(0.0, brow_rise(shape, uv.x()));
  };
  face.add({"brows", mixed(look.hair, kDark, 0.25), 0.8, 0.0012}, 12, 2,
           stroke(brow_inner, brow_outer, 0.0060, 0.0058), brows, true);
  constexpr MouthForm kRest = {0.0215, -0.0085, 0.0, -0.0215};
  constexpr double kLips = 0.0046;
  const Face::Move mouth = [=](FaceShape shape, const Vector2d& /*p*/, const Vector2d& uv) -> Vector2d {
    return mouth_place(mouth_form(shape, kRest), kLips, uv.x(), uv.y());
  };
  face.add(
      {"mouth", mixed(look.skin, 0x7A1F26, 0.72), 0.5, 0.0008}, 16, 4,
      [=](double u, double v) { return mouth_place(kRest, kLips, u, v); }, mouth, false);
  const Face::Move still = [](FaceShape /*shape*/, const Vector2d& p, const Vector2d& /*uv*/) { return p; };
  face.add({"cheeks", mixed(look.skin, 0xE0605A, 0.13), 0.62, 0.0006}, 8, 8,
           disc({0.0455, 0.0040}, {0.0105, 0.0068}), still, true);
}

void add_robot_face(Face& face, const AvatarLook& look) {
  const Vector2d eye(0.0300, 0.036);
  const Face::Move eyes = [=](FaceShape shape, const Vector2d& p, const Vector2d& uv) -> Vector2d {
    const double tall = closes(shape, p.x()) ? 0.10 : shape == FaceShape::surprised ? 1.25 : 1.0;
    const double slope = brow_rise(shape, uv.x());  // the upper edge takes the part of the brows
    const double edge = shape == FaceShape::surprised ? 0.0 : std::max(0.0, p.y() - eye.y()) / 0.0165 * slope;
    return Vector2d(p.x(), eye.y() + tall * (p.y() - eye.y()) + edge) + 0.006 * look_of(shape);
  };
  face.add({"eyes", look.eyes, 0.4, 0.0010, true}, 10, 10, disc(eye, {0.0115, 0.0165}), eyes, true);
  constexpr MouthForm kRest = {0.018, -0.0075, 0.0, 0.004};
  constexpr double kThickness = 0.0045;
  const Face::Move mouth = [=](FaceShape shape, const Vector2d& /*p*/, const Vector2d& uv) -> Vector2d {
    constexpr MouthForm kHuman = {0.0215, -0.0085, 0.0, -0.0215};
    MouthForm form = mouth_form(shape, kHuman);
    form.width *= kRest.width / kHuman.width;
    form.rise *= kRest.rise / kHuman.rise;
    form.y += kRest.y - kHuman.y;
    return mouth_place(form, kThickness, uv.x(), uv.y());
  };
  face.add(
      {"eyes", look.eyes, 0.4, 0.0010, true}, 14, 4,
      [=](double u, double v) { return mouth_place(kRest, kThickness, u, v); }, mouth, false);
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
