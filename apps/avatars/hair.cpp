// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "avatars/tailor.h"

namespace telemime {
namespace {

using Eigen::Vector3d;

constexpr double kRoughness = 0.55;
constexpr double kCell = 0.0065;

struct Barber {
  const Figure& figure;
  double s = figure.head_size();

  Field ball(double x, double y, double z, double rx, double ry, double rz) const {
    const SegmentScale& k = figure.head_shape;
    return ellipsoid(figure.in_head(x, y, z), s * Vector3d(rx * k.width, ry * k.length, rz * k.height));
  }
  /// Below and before a plane that falls from the hairline at the forehead to the nape.
  Field face_side(double forehead, double nape) const {
    const Vector3d front = figure.in_head(0.0, forehead, 0.075);
    const Vector3d back = figure.in_head(0.0, nape, -0.075);
    const Vector3d line = front - back;
    return half_space(front, Vector3d(0.0, line.z(), -line.y()).normalized());
  }
};

// A lock of hair on the skull, from one place to another (x, y of the head) seen from the front.
Field lock(const Barber& b, const Vector3d& from, const Vector3d& to, double thick, double thin) {
  return round_cone(b.figure.in_head(from.x(), from.y(), from.z()), b.figure.in_head(to.x(), to.y(), to.z()),
                    thick * b.s, thin * b.s);
}

Field cropped(const Barber& b) {
  Field cap = grown(b.figure.skull, 0.0095 * b.s);
  cap = without(std::move(cap), b.face_side(0.108, -0.014), 0.014 * b.s);
  cap = without(std::move(cap), b.ball(0.0, 0.034, 0.095, 0.076, 0.074, 0.066), 0.012 * b.s);
  // Swept over from the parting on the left.
  return blended({std::move(cap), lock(b, {0.030, 0.134, 0.030}, {-0.048, 0.120, 0.050}, 0.026, 0.019),
                  lock(b, {0.034, 0.124, 0.052}, {-0.034, 0.112, 0.070}, 0.021, 0.015),
                  lock(b, {0.040, 0.128, 0.020}, {0.068, 0.096, 0.030}, 0.020, 0.013),
                  lock(b, {0.000, 0.146, -0.010}, {-0.060, 0.120, 0.000}, 0.024, 0.017),
                  lock(b, {0.010, 0.138, -0.050}, {-0.030, 0.120, -0.075}, 0.026, 0.020)},
                 0.016 * b.s);
}

Field bob(const Barber& b) {
  Field mass = blended({grown(b.figure.skull, 0.016 * b.s), b.ball(0.0, 0.020, -0.020, 0.099, 0.120, 0.094)},
                       0.040 * b.s);
  Field fringe = b.ball(0.0, -0.012, 0.105, 0.066, 0.094, 0.100);
  mass = without(std::move(mass), std::move(fringe), 0.012 * b.s);
  return without(std::move(mass), half_space(b.figure.in_head(0.0, -0.070, 0.0), Vector3d::UnitY()),
                 0.016 * b.s);
}

Field bun(const Barber& b) {
  Field cap = without(grown(b.figure.skull, 0.010 * b.s), b.face_side(0.104, -0.020), 0.014 * b.s);
  cap = without(std::move(cap), b.ball(0.0, 0.026, 0.100, 0.066, 0.078, 0.060), 0.014 * b.s);
  return blended({std::move(cap), b.ball(0.0, 0.150, -0.072, 0.044, 0.040, 0.044)}, 0.012 * b.s);
}

}  // namespace

std::vector<AvatarPart> make_hair(const Figure& figure, const AvatarLook& look) {
  Tailor tailor{figure, look, {}};
  const Barber barber{figure};
  switch (look.hair_style) {
    case AvatarHair::none:
      add_robot_head(tailor);
      break;
    case AvatarHair::cropped:
      tailor.add("hair", look.hair, kRoughness, cropped(barber), tailor.head_box(), kCell);
      break;
    case AvatarHair::bob:
      tailor.add("hair", look.hair, kRoughness, bob(barber), tailor.head_box(), kCell);
      break;
    case AvatarHair::bun:
      tailor.add("hair", look.hair, kRoughness, bun(barber), tailor.head_box(), kCell);
      break;
  }
  return std::move(tailor.parts);
}

}  // namespace telemime
