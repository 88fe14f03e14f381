// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include "avatars/tailor.h"

namespace telemime {
namespace {

using Eigen::Vector3d;

constexpr double kSkinRoughness = 0.62;
constexpr double kClothRoughness = 0.92;

// Cells of the grids, m of a person of 1.70 m: as coarse as hides the facets.
constexpr double kCloth = 0.0125;
constexpr double kHead = 0.0068;
constexpr double kArm = 0.0100;
constexpr double kHand = 0.0050;
constexpr double kShoe = 0.0080;
constexpr double kTrim = 0.0042;

void add_skin(Tailor& t, double sleeve) {
  const Figure& f = t.figure;
  const double neck = f.at(HumanBone::neck).y();
  Field bust = overlap(blended({f.head, f.neck, f.torso}, t.m(0.035)),
                       overlap(t.above(neck - t.m(0.13)), Tailor::within(t.m(0.13)), t.m(0.01)), t.m(0.01));
  t.add("skin", t.look.skin, kSkinRoughness, bust, t.head_box(), kHead);
  // Arm and hand are two surfaces of one solid, so that only the fingers need small cells.
  const Field arm = blended({f.arms, f.hands}, t.m(0.012));
  const double wrist = f.at(HumanBone::l_hand).x();
  t.add_pair("skin", t.look.skin, kSkinRoughness,
             overlap(arm, overlap(Tailor::beyond(sleeve - t.m(0.035)), Tailor::within(wrist), t.m(0.01)),
                     t.m(0.006)),
             t.arm_box(), kArm);
  t.add_pair("skin", t.look.skin, kSkinRoughness,
             overlap(arm, Tailor::beyond(wrist - t.m(0.020)), t.m(0.006)), t.hand_box(), kHand);
}

void add_trousers(Tailor& t) {
  const double waist = t.figure.at(HumanBone::hips).y() + t.m(0.10);
  const double ankle = t.figure.at(HumanBone::l_foot).y() + t.m(0.018);
  // Wider below the knee, or they look like tights.
  const double knee = t.figure.at(HumanBone::l_lower_leg).y();
  Field cloth = [legs = t.lower_body(), knee, ankle, s = t.figure.scale](const Vector3d& p) {
    const double down = std::clamp((knee - p.y()) / (knee - ankle), 0.0, 1.0);
    return legs(p) - s * (0.006 + 0.013 * down);
  };
  t.add("trousers", t.look.trousers, kClothRoughness,
        overlap(std::move(cloth), overlap(t.above(ankle), t.below(waist), t.m(0.004)), t.m(0.008)),
        t.lower_box(), kCloth);
}

void add_shoes(Tailor& t) {
  const double sole = t.m(0.020);
  t.add_pair("shoes", t.look.shoes, 0.7, overlap(t.figure.feet, t.above(0.6 * sole), t.m(0.004)),
             t.foot_box(), kShoe);
  t.add_pair("soles", 0xF7F5F0, 0.8,
             overlap(grown(t.figure.feet, t.m(0.0045)), overlap(t.below(sole), t.above(0.0), t.m(0.003)),
                     t.m(0.006)),
             t.foot_box(), kShoe);
}

// A hollow about the neck.
Field neckline(const Tailor& t, double radius, double drop) {
  const Vector3d& neck = t.figure.at(HumanBone::neck);
  return ellipsoid(neck + t.figure.scale * Vector3d(0.0, 0.045 - drop, 0.022),
                   t.figure.scale * Vector3d(radius, 0.072, radius));
}

// What hangs about trunk and arms, `loose` m off the skin.
Field loose_cloth(const Tailor& t, double loose) {
  const Figure& f = t.figure;
  const double shoulder = f.at(HumanBone::l_upper_arm).x();
  // Cloth hangs straight from the chest instead of following the waist, and sleeves widen.
  const double chest = f.at(HumanBone::chest).y();
  return [skin = t.upper_body(t.m(0.075)), loose, shoulder, chest, s = f.scale](const Vector3d& p) {
    const double along = std::clamp((std::abs(p.x()) - shoulder) / (0.25 * s), 0.0, 1.0);
    const double down = std::clamp((chest - p.y()) / (0.25 * s), 0.0, 1.0);
    return skin(p) - loose - s * (0.004 * along + 0.008 * down);
  };
}

// Down to the hem, out to the ends of the sleeves.
Field cut(const Tailor& t, const Field& cloth, double hem, double sleeve) {
  return overlap(cloth, overlap(t.above(hem), Tailor::within(sleeve), t.m(0.004)), t.m(0.008));
}

// A turned-over edge at the hem, of the garment's own colour.
void add_hem(Tailor& t, const Field& cloth, double hem) {
  t.add("top", t.look.top, kClothRoughness, seam(cloth, t.below(hem + t.m(0.004)), t.m(0.0062)),
        t.box({0.0, hem, t.m(0.03)}, 0.26, 0.025, 0.20), 0.0062);
}

// The band along a neckline and about the ends of the sleeves.
void add_bands(Tailor& t, const Field& cloth, const Field& neckline, double sleeve) {
  const Vector3d& neck = t.figure.at(HumanBone::neck);
  t.add("trim", t.look.trim, kClothRoughness, seam(cloth, neckline, t.m(0.0058)),
        t.box(neck, 0.15, 0.14, 0.16), kTrim);
  const Vector3d end(sleeve, t.figure.at(HumanBone::l_upper_arm).y(), 0.0);
  t.add_pair("trim", t.look.trim, kClothRoughness,
             seam(cloth, Tailor::within(sleeve - t.m(0.004)), t.m(0.0058)), t.box(end, 0.03, 0.13, 0.12),
             kTrim);
}

void dress_tee(Tailor& t) {
  const double sleeve = t.sleeve_end(t.look.sleeve);
  const double hem = t.figure.at(HumanBone::hips).y() - t.m(0.030);
  add_skin(t, sleeve);
  const Field cloth = loose_cloth(t, t.m(0.007));
  const Field hollow = neckline(t, 0.086, 0.0);
  t.add("top", t.look.top, kClothRoughness, without(cut(t, cloth, hem, sleeve), hollow, t.m(0.006)),
        t.upper_box(), kCloth);
  add_bands(t, cloth, hollow, sleeve);
  add_hem(t, cloth, hem);
}

void dress_hoodie(Tailor& t) {
  const Figure& f = t.figure;
  const double sleeve = t.sleeve_end(t.look.sleeve);
  const double hem = f.at(HumanBone::hips).y() - t.m(0.050);
  add_skin(t, sleeve);
  const Field cloth = loose_cloth(t, t.m(0.012));
  const Vector3d& neck = f.at(HumanBone::neck);
  const auto at = [&](double x, double y, double z) -> Vector3d {
    return neck + f.scale * Vector3d(x, y, z);
  };
  // The hood lies about the neck and down the back.
  Field hood = blended(
      {mirror_x(round_cone(at(0.012, -0.066, 0.096), at(0.084, 0.010, 0.012), t.m(0.018), t.m(0.029))),
       mirror_x(round_cone(at(0.084, 0.010, 0.012), at(0.0, -0.004, -0.090), t.m(0.029), t.m(0.044))),
       ellipsoid(at(0.0, -0.045, -0.090), f.scale * Vector3d(0.125, 0.075, 0.044))},
      t.m(0.030));
  t.add("top", t.look.top, kClothRoughness,
        blended({without(cut(t, cloth, hem, sleeve), neckline(t, 0.080, 0.0), t.m(0.006)), std::move(hood)},
                t.m(0.022)),
        t.upper_box(), 0.85 * kCloth);
  t.add("top", t.look.top, kClothRoughness, seam(cloth, neckline(t, 0.080, 0.0), t.m(0.0062)),
        t.box(neck, 0.15, 0.14, 0.16), kTrim);
  // Knitted cuffs and hem, and the cords of the hood.
  const auto band = [&](Field solid, Field side, Field other) {
    return overlap(std::move(solid), overlap(std::move(side), std::move(other), t.m(0.003)), t.m(0.008));
  };
  const Vector3d cuff(sleeve, f.at(HumanBone::l_hand).y(), f.at(HumanBone::l_hand).z());
  t.add_pair("trim", t.look.trim, kClothRoughness,
             band(grown(f.arms, t.m(0.0115)), Tailor::beyond(sleeve - t.m(0.012)),
                  Tailor::within(sleeve + t.m(0.020))),
             t.box(cuff, 0.06, 0.07, 0.07), kShoe);
  t.add("trim", t.look.trim, kClothRoughness,
        band(grown(cloth, -t.m(0.001)), t.above(hem - t.m(0.024)), t.below(hem + t.m(0.010))),
        t.box({0.0, hem, 0.03 * f.scale}, 0.26, 0.07, 0.2), kArm);
  const auto cord = mirror_x(
      blended({round_cone(at(0.026, -0.080, 0.118), at(0.031, -0.180, 0.140), t.m(0.0042), t.m(0.0042)),
               round_cone(at(0.031, -0.176, 0.139), at(0.031, -0.192, 0.141), t.m(0.0062), t.m(0.0062))},
              t.m(0.002)));
  t.add("trim", t.look.trim, kClothRoughness, cord, t.box(at(0.0, -0.13, 0.13), 0.05, 0.10, 0.06), 0.0035);
}

// Where a jacket is open: a V from the neck down to the button, and a slit below it.
Field opening(const Tailor& t, double button, double wide, double slit) {
  const double neck = t.figure.at(HumanBone::neck).y();
  return [button, neck, wide, slit, s = t.figure.scale](const Vector3d& p) {
    const double up = (p.y() - button) / (neck - button);
    const double half = up > 0.0 ? wide * s * std::min(up, 1.3) : slit * s * -up;
    return std::max(0.96 * (std::abs(p.x()) - half), 0.02 * s - p.z());
  };
}

void add_shirt(Tailor& t, const Field& skin, double hem, double sleeve) {
  const Figure& f = t.figure;
  const Vector3d& neck = f.at(HumanBone::neck);
  // The collar's upper edge falls to the front; it stands off the more, the lower it gets.
  const Field edge = half_space(neck + f.scale * Vector3d(0.0, 0.056, 0.0), Vector3d(0.0, 0.88, 0.475));
  t.add("shirt", t.look.trim, kClothRoughness,
        // Only the front of it is ever seen.
        overlap(overlap(grown(skin, t.m(0.007)), half_space({0.0, 0.0, 0.0}, -Vector3d::UnitZ()), t.m(0.004)),
                overlap(overlap(t.above(hem), grown(edge, -t.m(0.016)), t.m(0.004)),
                        Tailor::within(t.m(0.13)), t.m(0.004)),
                t.m(0.006)),
        t.box(neck - f.scale * Vector3d(0.0, 0.30, -0.02), 0.15, 0.36, 0.17), kArm);
  Field shell = [neck_skin = f.neck, edge, s = f.scale](const Vector3d& p) {
    return 0.95 * (std::abs(neck_skin(p) - s * 0.0095 + 0.30 * std::min(edge(p), 0.0)) - s * 0.0050);
  };
  Field notch = [edge, front = neck.z() + 0.02 * f.scale, s = f.scale](const Vector3d& p) {
    return p.z() > front ? 0.9 * (std::abs(p.x()) + 0.45 * edge(p) - 0.0005 * s) : front - p.z() + 0.01 * s;
  };
  Field collar =
      overlap(std::move(shell),
              overlap(
                  edge, [edge, s = f.scale](const Vector3d& p) { return -edge(p) - 0.048 * s; }, t.m(0.003)),
              t.m(0.004));
  t.add("shirt", t.look.trim, kClothRoughness, without(std::move(collar), std::move(notch), t.m(0.004)),
        t.box(neck, 0.13, 0.12, 0.15), 0.0040);
  const Vector3d cuff(sleeve, f.at(HumanBone::l_hand).y(), f.at(HumanBone::l_hand).z());
  t.add_pair(
      "shirt", t.look.trim, kClothRoughness,
      overlap(grown(f.arms, t.m(0.0085)),
              overlap(Tailor::beyond(sleeve - t.m(0.03)), Tailor::within(sleeve + t.m(0.012)), t.m(0.003)),
              t.m(0.004)),
      t.box(cuff, 0.06, 0.07, 0.07), kShoe);
}

void add_tie(Tailor& t, const Field& skin, double button) {
  const Vector3d& neck = t.figure.at(HumanBone::neck);
  const double knot = neck.y() - t.m(0.038);
  Field outline = [knot, button, s = t.figure.scale](const Vector3d& p) {
    const double down = (knot - p.y()) / (knot - button);
    const double half =
        down < 0.09 ? s * (0.021 - 0.09 * std::max(down, -0.1)) : s * (0.0125 + 0.018 * std::min(down, 1.2));
    return std::max({0.97 * (std::abs(p.x()) - half), p.y() - knot - 0.014 * s, 0.02 * s - p.z()});
  };
  // The knot is thicker than the rest.
  Field cloth = [skin, knot, s = t.figure.scale](const Vector3d& p) {
    const double near = std::clamp(1.0 - (knot - p.y()) / (0.03 * s), 0.0, 1.0);
    return skin(p) - s * (0.0115 + 0.008 * near);
  };
  const double end = button - t.m(0.02);
  t.add("tie", 0x9C2F3A, 0.6,
        overlap(std::move(cloth), overlap(std::move(outline), t.above(end), t.m(0.004)), t.m(0.005)),
        t.box({0.0, 0.5 * (knot + end), neck.z() + t.m(0.09)}, 0.05,
              0.5 * (knot - end) / t.figure.scale + 0.05, 0.09),
        0.0052);
}

void dress_jacket(Tailor& t) {
  const Figure& f = t.figure;
  const double sleeve = t.sleeve_end(t.look.sleeve);
  const double hem = f.at(HumanBone::hips).y() - t.m(0.075);
  const double button = f.at(HumanBone::spine).y() + t.m(0.12);
  const Vector3d& neck = f.at(HumanBone::neck);
  add_skin(t, sleeve);
  const Field skin = blended({t.upper_body(t.m(0.075)), f.neck}, t.m(0.030));
  add_shirt(t, skin, f.at(HumanBone::hips).y() + t.m(0.03), sleeve);
  add_tie(t, skin, button);
  const Field cloth = loose_cloth(t, t.m(0.018));
  const Field open = opening(t, button, 0.072, 0.0);
  const Field hollow = neckline(t, 0.080, -0.004);
  t.add("top", t.look.top, 0.85,
        without(without(cut(t, cloth, hem, sleeve), open, t.m(0.008)), hollow, t.m(0.006)), t.upper_box(),
        0.85 * kCloth);
  add_hem(t, without(cloth, open, t.m(0.008)), hem);
  // Lapels lie on it along the opening.
  Field lapel =
      overlap(grown(cloth, t.m(0.0055)),
              overlap(opening(t, button - t.m(0.005), 0.122, 0.0),
                      overlap(t.above(button), t.below(neck.y() - t.m(0.035)), t.m(0.002)), t.m(0.003)),
              t.m(0.006));
  lapel = overlap(without(std::move(lapel), grown(open, t.m(0.001)), t.m(0.005)),
                  half_space(neck + f.scale * Vector3d(0.0, 0.0, 0.045), -Vector3d::UnitZ()), t.m(0.003));
  t.add("lapels", 0x263045, 0.8, lapel,
        t.box({0.0, 0.5 * (neck.y() + button), neck.z() + t.m(0.10)}, 0.15, 0.26, 0.10), 0.0062);
  for (const double below : {0.012, 0.085}) {
    const double y = button - t.m(below);
    Field disc = overlap(
        grown(cloth, t.m(0.005)),
        round_cone({t.m(0.012), y, 0.0}, {t.m(0.012), y, t.m(0.3)}, t.m(0.0095), t.m(0.0095)), t.m(0.003));
    t.add("lapels", 0x263045, 0.8,
          overlap(std::move(disc), half_space({0.0, y, t.m(0.1)}, -Vector3d::UnitZ()), t.m(0.002)),
          t.box({t.m(0.012), y, t.m(0.17)}, 0.02, 0.02, 0.08), 0.0035);
  }
}

}  // namespace

std::vector<AvatarPart> make_outfit(const Figure& figure, const AvatarLook& look) {
  Tailor tailor{figure, look, {}};
  switch (look.top_style) {
    case TopStyle::tee:
      dress_tee(tailor);
      break;
    case TopStyle::hoodie:
      dress_hoodie(tailor);
      break;
    case TopStyle::jacket:
      dress_jacket(tailor);
      break;
    case TopStyle::shell:
      dress_robot(tailor);
      return std::move(tailor.parts);
  }
  add_trousers(tailor);
  add_shoes(tailor);
  return std::move(tailor.parts);
}

}  // namespace telemime
