// SPDX-License-Identifier: Apache-2.0
#include "lab/synth/avatar.h"

namespace telemime {
namespace {

using Eigen::Vector3f;

// The solids were fitted to the front of MediaPipe's canonical face (telemime/body/face_model.h), which they
// meet to 0.8 mm (root mean square).
constexpr float kEyeX = 0.0315f;
constexpr float kEyeY = 0.0355f;
constexpr float kMouthY = -0.0335f;

Vector3f blend(const Vector3f& a, const Vector3f& b, float t) {
  return a + (b - a) * std::clamp(t, 0.0f, 1.0f);
}

// 1 at the centre of an axis-parallel bump, 0 far away.
float bump(float x, float y, float width, float height) {
  return std::exp(-(x * x) / (width * width) - (y * y) / (height * height));
}

float skull(const AvatarHead& head, const Vector3f& p) {
  const float cranium =
      ellipsoid(p - Vector3f(0.0f, 0.0674f, 0.0060f), {0.0764f * head.width, 0.0796f, 0.0944f});
  const float jaw =
      ellipsoid(p - Vector3f(0.0f, -0.0123f, 0.0315f), {0.0601f * head.width, 0.0839f, 0.0615f});
  return smooth_union(cranium, jaw, 0.0532f);
}

}  // namespace

float face_distance(const AvatarHead& head, const Vector3f& at) {
  const Vector3f p(std::abs(at.x()), at.y(), at.z());  // the two halves are alike
  float d = skull(head, p);
  if (d > 0.070f) {
    return d - 0.03f;  // nose and ears reach 25 mm beyond the skull
  }
  const auto corner = [&](float x, float y, float z, float radius) {
    return (p - Vector3f(x, y, z)).norm() - radius;
  };
  static const RoundCone kNose =
      round_cone({0.0f, 0.0403f, 0.0918f}, {0.0f, 0.0047f, 0.1137f}, 0.0059f, 0.0121f);
  static const RoundCone kBrow =
      round_cone({0.0236f, 0.0498f, 0.0932f}, {0.0471f, 0.0575f, 0.0746f}, 0.0122f, 0.0087f);
  static const RoundCone kCheek =
      round_cone({0.0329f, -0.0023f, 0.0710f}, {0.0533f, 0.0134f, 0.0394f}, 0.0161f, 0.0198f);
  // Chin and corners of the jaw, cheeks, brows.
  d = smooth_union(d, corner(0.0f, -0.0667f, 0.0720f, 0.0276f), 0.0356f);
  d = smooth_union(d, corner(0.0306f * head.jaw, -0.0319f, 0.0434f, 0.0295f), 0.030f);
  d = smooth_union(d, distance(kCheek, p), 0.022f);
  d = smooth_union(d, distance(kBrow, p), 0.014f);
  // Sockets and eyes.
  d = smooth_intersection(d, -corner(0.0255f, 0.0361f, 0.0995f, 0.0087f), 0.0291f);
  d = smooth_union(d, corner(0.0291f, 0.0382f, 0.0795f, 0.0105f), 0.004f);
  // Nose, mouth and lips.
  d = smooth_union(d, distance(kNose, p), 0.0138f);
  d = smooth_union(d, corner(0.0115f, -0.0003f, 0.1018f, 0.0066f), 0.006f);
  d = smooth_union(d, ellipsoid(p - Vector3f(0.0f, -0.0283f, 0.0796f), {0.0311f, 0.0218f, 0.0133f}), 0.014f);
  d = smooth_union(d, ellipsoid(p - Vector3f(0.0f, -0.0217f, 0.1003f), {0.0203f, 0.0073f, 0.0099f}), 0.014f);
  d = smooth_union(d, ellipsoid(p - Vector3f(0.0f, -0.0410f, 0.0994f), {0.0185f, 0.0060f, 0.0060f}), 0.007f);
  // Ears lean backward and stand off a little.
  const Vector3f ear = p - Vector3f(0.0780f * head.width, 0.021f, 0.0f);
  const Vector3f turned(ear.x() + 0.30f * ear.z(), ear.y() - 0.15f * ear.z(), ear.z() + 0.15f * ear.y());
  const float shell = ellipsoid(turned, {0.0075f, 0.0310f, 0.0185f});
  const float bowl = ellipsoid(turned - Vector3f(0.0085f, 0.002f, 0.003f), {0.0075f, 0.0190f, 0.0100f});
  return smooth_union(d, smooth_intersection(shell, -bowl, 0.004f), 0.006f);
}

float hair_distance(const AvatarHead& head, const Vector3f& at) {
  const Vector3f p(std::abs(at.x()), at.y(), at.z());
  const float thick = head.style == HairStyle::cap ? 0.004f : 0.011f;
  float d = ellipsoid(p - Vector3f(0.0f, 0.0674f + 0.3f * thick, 0.0040f),
                      {0.0774f * head.width + thick, 0.0801f + thick, 0.0949f + 0.8f * thick});
  // The hairline: over the forehead at the top, before the ear at the side, down to the nape behind.
  const float side = smooth_step(0.030f, 0.070f, p.x());
  const float hairline = 0.098f - 0.052f * side * side;
  const float line = (hairline - p.y() + 0.92f * (p.z() - 0.091f + 0.062f * side)) * 0.62f;
  d = smooth_intersection(d, line, 0.008f);
  if (head.style == HairStyle::bob) {
    // Falls beside and behind the neck; the face stays free.
    static const RoundCone kLock =
        round_cone({0.066f, 0.060f, -0.015f}, {0.078f, -0.085f, -0.018f}, 0.024f, 0.020f);
    static const RoundCone kBack =
        round_cone({0.030f, 0.050f, -0.065f}, {0.040f, -0.090f, -0.045f}, 0.040f, 0.034f);
    d = smooth_union(d, distance(kLock, p), 0.030f);
    d = smooth_union(d, distance(kBack, p), 0.030f);
  }
  return d;
}

Vector3f face_colour(const Look& look, const Vector3f& at) {
  const float x = std::abs(at.x());
  const float y = at.y();
  Vector3f c = look.skin * (1.0f + 0.05f * value_noise(at * 60.0f, look.texture));
  const Vector3f red(c.x() * 0.98f, c.y() * 0.76f, c.z() * 0.74f);
  // Ears, nose tip and cheeks are redder, the forehead paler.
  c = blend(c, red, 0.45f * bump(x - 0.044f, y - 0.006f, 0.020f, 0.016f));
  c = blend(c, red, 0.45f * bump(x, y - 0.004f, 0.013f, 0.010f));
  c = blend(c, red, 0.5f * smooth_step(0.078f, 0.086f, x));
  if (at.z() < 0.045f) {
    return c;
  }
  const Vector3f shade = c.cwiseProduct(Vector3f(0.52f, 0.44f, 0.42f));
  const float ex = x - kEyeX;
  const float ey = y - kEyeY;
  // Sockets, the sides of the nose, nostrils, the fold under the lower lip.
  c = blend(c, shade, 0.75f * bump(ex, ey - 0.003f, 0.0200f, 0.0105f));
  c = blend(c, shade, 0.55f * bump(x - 0.0135f, y - 0.034f, 0.0050f, 0.0120f));
  c = blend(c, shade, 0.35f * bump(x - 0.0180f, y - 0.0005f, 0.0040f, 0.0090f));
  c = blend(c, shade * 0.45f, 0.85f * bump(x - 0.0072f, y + 0.0085f, 0.0036f, 0.0024f));
  c = blend(c, shade, 0.40f * bump(x, y + 0.0530f, 0.0130f, 0.0035f));
  c = blend(c, shade, 0.25f * bump(x, y + 0.0180f, 0.0050f, 0.0060f));

  // Brows: an arch, thick by the nose and thin at the temple.
  const float along = (x - 0.011f) / 0.046f;
  if (along > 0.0f && along < 1.0f) {
    const float arch = 0.0545f + (0.0153f - 0.0193f * along) * along;
    const float half = 0.0042f - 0.0024f * along * along;
    const float ends = smooth_step(0.0f, 0.08f, along) * (1.0f - smooth_step(0.85f, 1.0f, along));
    c = blend(c, look.hair * 1.2f,
              0.88f * ends * (1.0f - smooth_step(half * 0.7f, half * 1.3f, std::abs(y - arch))));
  }

  // Eyes: an almond with iris and pupil, a dark upper lid.
  const float u = ex / 0.0137f;
  if (std::abs(u) < 1.0f) {
    const float open = 1.0f - u * u;
    const float upper = 0.0054f * open;
    const float lower = -0.0042f * open;
    const float inside =
        smooth_step(-0.0006f, 0.0006f, upper - ey) * smooth_step(-0.0006f, 0.0006f, ey - lower);
    const float iris = std::hypot(ex, ey - 0.0006f);
    Vector3f eye(0.46f, 0.43f, 0.42f);
    eye = blend(eye, look.eyes, 1.0f - smooth_step(0.0050f, 0.0058f, iris));
    eye = blend(eye, Vector3f(0.004f, 0.004f, 0.004f), 1.0f - smooth_step(0.0022f, 0.0028f, iris));
    eye = blend(eye, Vector3f(0.9f, 0.9f, 0.9f),
                0.8f * bump(at.x() - std::copysign(kEyeX, at.x()) - 0.002f, ey - 0.003f, 0.0012f, 0.0012f));
    c = blend(c, eye, inside);
    const float lid = 1.0f - smooth_step(0.0006f, 0.0021f, std::abs(ey - upper - 0.0006f));
    c = blend(c, Vector3f(0.014f, 0.010f, 0.008f), 0.88f * lid);
    c = blend(c, shade, 0.5f * (1.0f - smooth_step(0.0003f, 0.0014f, std::abs(ey - lower))));
  }

  // Lips: two bows and the dark line between them.
  const float v = x / 0.0246f;
  if (v < 1.0f) {
    const float my = y - kMouthY;
    const float upper = 0.0095f * (1.0f - v * v) * (1.0f - 0.18f * bump(x, 0.0f, 0.005f, 1.0f));
    const float lower = -0.0105f * std::sqrt(1.0f - v * v);
    const float inside =
        smooth_step(-0.0008f, 0.0008f, upper - my) * smooth_step(-0.0010f, 0.0010f, my - lower);
    const Vector3f lip = look.skin.cwiseProduct(Vector3f(0.74f, 0.42f, 0.44f));
    c = blend(c, lip, 0.85f * inside);
    const float line = 1.0f - smooth_step(0.0004f, 0.0017f, std::abs(my - 0.0012f * v * v));
    c = blend(c, lip * 0.12f, 0.85f * line);
  }
  return c;
}

}  // namespace telemime
