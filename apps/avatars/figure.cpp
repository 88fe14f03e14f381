// SPDX-License-Identifier: Apache-2.0
#include "avatars/figure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "telemime/outputs/t_pose.h"

namespace telemime {
namespace {

using Eigen::Vector3d;

constexpr double kDesignStature = 1.70;
// A head a little larger than life looks friendlier.
constexpr double kHeadScale = 1.12;

// All numbers below are metres of a person of 1.70 m.
// Trunk: height above the spine's joint, centre in z, half width, half depth.
constexpr std::array<LoftRing, 12> kTorso = {{{-0.165, 0.040, 0.070, 0.062},
                                              {-0.130, 0.040, 0.138, 0.094},
                                              {-0.060, 0.040, 0.160, 0.108},
                                              {0.020, 0.044, 0.150, 0.103},
                                              {0.100, 0.048, 0.137, 0.096},
                                              {0.180, 0.048, 0.138, 0.100},
                                              {0.280, 0.046, 0.148, 0.108},
                                              {0.370, 0.040, 0.157, 0.110},
                                              {0.440, 0.030, 0.158, 0.098},
                                              {0.500, 0.019, 0.140, 0.078},
                                              {0.545, 0.012, 0.092, 0.062},
                                              {0.580, 0.010, 0.058, 0.052}}};
// Arm from the shoulder, along x: fraction of the upper arm (0 to 1), then 1 + fraction of the forearm; half
// height, half depth (the palm looks down).
constexpr std::array<LoftRing, 13> kArm = {{{-0.22, 0.0, 0.042, 0.044},
                                            {0.00, 0.0, 0.051, 0.053},
                                            {0.15, 0.0, 0.052, 0.055},
                                            {0.35, 0.0, 0.051, 0.052},
                                            {0.60, 0.0, 0.045, 0.046},
                                            {0.85, 0.0, 0.040, 0.041},
                                            {1.00, 0.0, 0.038, 0.040},
                                            {1.18, 0.0, 0.040, 0.043},
                                            {1.40, 0.0, 0.037, 0.040},
                                            {1.65, 0.0, 0.030, 0.034},
                                            {1.85, 0.0, 0.024, 0.030},
                                            {1.97, 0.0, 0.021, 0.028},
                                            {2.08, 0.0, 0.019, 0.027}}};
// Palm from the wrist, along x, as fractions of wrist to knuckle; half height, half depth.
constexpr std::array<LoftRing, 6> kPalm = {{{-0.12, 0.0, 0.018, 0.026},
                                            {0.10, 0.001, 0.018, 0.029},
                                            {0.40, 0.003, 0.0175, 0.037},
                                            {0.80, 0.002, 0.0155, 0.041},
                                            {1.00, 0.001, 0.0130, 0.040},
                                            {1.10, 0.0, 0.0080, 0.036}}};
// Leg: fraction of the thigh from hip to knee (0 to 1), then 1 + fraction of the shank; centre in z, half
// width, half depth.
constexpr std::array<LoftRing, 10> kLeg = {{{-0.12, 0.036, 0.070, 0.080},
                                            {0.05, 0.036, 0.082, 0.090},
                                            {0.30, 0.032, 0.080, 0.085},
                                            {0.60, 0.024, 0.068, 0.071},
                                            {0.90, 0.014, 0.056, 0.058},
                                            {1.05, 0.008, 0.052, 0.055},
                                            {1.30, -0.006, 0.053, 0.058},
                                            {1.60, -0.008, 0.045, 0.049},
                                            {1.88, -0.004, 0.036, 0.040},
                                            {2.02, 0.000, 0.036, 0.042}}};

template <std::size_t n>
std::vector<LoftRing> scaled(const std::array<LoftRing, n>& rings, double along, double side, double front) {
  std::vector<LoftRing> result;
  result.reserve(n);
  for (const LoftRing& r : rings) {
    result.push_back({r.at * along, r.centre * front, r.radius_side * side, r.radius_front * front});
  }
  return result;
}

// Rings whose place counts bones: below 1 the first, then the second.
template <std::size_t n>
std::vector<LoftRing> along_two(const std::array<LoftRing, n>& rings, double first, double second,
                                double scale) {
  std::vector<LoftRing> result = scaled(rings, 1.0, scale, scale);
  for (LoftRing& r : result) {
    r.at = r.at <= 1.0 ? r.at * first : first + (r.at - 1.0) * second;
  }
  return result;
}

// Where a finger starts and ends, from the wrist: x in palm lengths, z and length in m; beside the thumb.
struct Finger {
  double x, z, z_end, length, radius;
};
constexpr std::array<Finger, kFingerCount - 1> kFingers = {{{0.97, 0.0300, 0.0370, 0.074, 0.0090},
                                                            {1.02, 0.0105, 0.0125, 0.081, 0.0093},
                                                            {0.99, -0.0095, -0.0115, 0.075, 0.0088},
                                                            {0.91, -0.0285, -0.0350, 0.061, 0.0078}}};

// The finger bones run in the middle of the fingers: bones of a half, three tenths and a fifth of the length.
FingerSkeleton finger_bones(const Body& body, double s) {
  constexpr double kLast = 0.8;
  const double palm = body.hand_length[0];
  const double wide = body.shape[Segment::l_hand].height;
  FingerSkeleton bones;
  const auto put = [&bones](std::size_t finger, const std::array<Vector3d, 4>& points) {
    for (std::size_t i = 0; i < 3; ++i) {
      for (const Side side : {Side::left, Side::right}) {
        const Vector3d mirror(side_sign(side), 1.0, 1.0);
        bones.position[finger_bone(side, finger, i)] = points[i].cwiseProduct(mirror);
        bones.end[finger_bone(side, finger, i)] = points[i + 1].cwiseProduct(mirror);
      }
    }
  };
  put(0, {s * Vector3d(0.022, -0.004, 0.018), s * Vector3d(0.058, -0.010, 0.052),
          s * Vector3d(0.077, -0.012, 0.062), s * Vector3d(0.098, -0.014, 0.073)});
  for (std::size_t f = 1; f < kFingerCount; ++f) {
    const Finger& finger = kFingers.at(f - 1);
    const auto at = [&](double along, double y) -> Vector3d {
      return {finger.x * palm + along * finger.length * s, s * y,
              std::lerp(finger.z, finger.z_end, along) * s * wide};
    };
    const Vector3d middle = at(0.5, -0.001);
    const Vector3d tip = at(1.0, -0.008);
    put(f, {at(0.0, 0.001), middle, middle + (kLast - 0.5) / 0.5 * (tip - middle), tip});
  }
  return bones;
}

Field hand(const Body& body, const Vector3d& wrist, const FingerSkeleton& bones, double s) {
  const double palm = body.hand_length[0];
  const SegmentScale& width = body.shape[Segment::l_hand];
  Field solid = loft(wrist, Vector3d::UnitX(), Vector3d::UnitZ(),
                     scaled(kPalm, palm, s * width.width, s * width.height));
  std::vector<Field> fingers;
  for (std::size_t f = 1; f < kFingerCount; ++f) {
    const double radius = kFingers.at(f - 1).radius * s;
    const std::size_t first = finger_bone(Side::left, f, 0);
    const Vector3d base = wrist + bones.position[first] - 0.12 * palm * Vector3d::UnitX();
    const Vector3d middle = wrist + bones.position[first + 1];
    const Vector3d tip = wrist + bones.end[first + 2] - radius * Vector3d::UnitX();
    fingers.push_back(blended({round_cone(base, middle, 1.08 * radius, 0.96 * radius),
                               round_cone(middle, tip, 0.96 * radius, 0.80 * radius)},
                              0.003 * s));
  }
  // Fingers are joined sharply with each other and softly with the palm: they must not grow webs.
  Field all = [fingers = std::move(fingers)](const Vector3d& p) {
    double value = fingers.front()(p);
    for (const Field& f : fingers) {
      value = std::min(value, f(p));
    }
    return value;
  };
  const auto thumb_at = [&](std::size_t i) -> Vector3d { return wrist + bones.position[i]; };
  const Vector3d thumb_tip = wrist + bones.end[2] - s * Vector3d(0.006, 0.0, 0.003);
  Field thumb = blended({round_cone(thumb_at(0), thumb_at(1), 0.0165 * s, 0.0115 * s),
                         round_cone(thumb_at(1), thumb_tip, 0.0112 * s, 0.0088 * s)},
                        0.006 * s);
  return blended({blended({std::move(solid), std::move(all)}, 0.007 * s), std::move(thumb)}, 0.014 * s);
}

Field foot(const Vector3d& ankle, double s) {
  const auto at = [&](double x, double y, double z) -> Vector3d {
    return {ankle.x() + s * x, s * y, ankle.z() + s * z};
  };
  Field solid = blended({round_cone(at(0.0, 0.050, -0.028), at(0.004, 0.044, 0.060), 0.043 * s, 0.043 * s),
                         round_cone(at(0.004, 0.036, 0.070), at(0.010, 0.030, 0.140), 0.045 * s, 0.040 * s),
                         round_cone(at(0.0, 0.060, -0.010), at(0.0, 0.105, -0.006), 0.046 * s, 0.043 * s)},
                        0.040 * s);
  return overlap(std::move(solid), half_space(Vector3d::Zero(), -Vector3d::UnitY()), 0.006 * s);
}

void add_head(Figure& figure) {
  const double s = figure.head_size();
  const auto ball = [&](double x, double y, double z, double rx, double ry, double rz) {
    const SegmentScale& scale = figure.head_shape;
    return ellipsoid(figure.in_head(x, y, z),
                     s * Vector3d(rx * scale.width, ry * scale.length, rz * scale.height));
  };
  figure.skull =
      blended({ball(0.0, 0.070, -0.010, 0.077, 0.082, 0.090), ball(0.0, 0.040, 0.012, 0.069, 0.062, 0.072),
               ball(0.0, -0.012, 0.030, 0.047, 0.050, 0.050)},
              0.060 * s);
  Field nose =
      blended({ball(0.0, 0.015, 0.097, 0.0125, 0.0105, 0.014), ball(0.0, 0.034, 0.090, 0.008, 0.020, 0.009)},
              0.012 * s);
  Field ear = blended(
      {ball(0.092, 0.033, -0.008, 0.008, 0.027, 0.017), ball(0.086, 0.018, 0.000, 0.008, 0.016, 0.010)},
      0.010 * s);
  figure.head =
      blended({blended({figure.skull, std::move(nose)}, 0.014 * s), mirror_x(std::move(ear))}, 0.008 * s);
}

}  // namespace

Vector3d Figure::in_head(double x, double y, double z) const {
  return at(HumanBone::head) +
         head_size() * Vector3d(x * head_shape.width, y * head_shape.length, z * head_shape.height);
}

double Figure::head_size() const {
  return scale * kHeadScale;
}

Figure make_figure(const Body& body) {
  using enum HumanBone;
  Figure figure;
  figure.skeleton = humanoid_skeleton(body);
  figure.scale = body.shape.stature / kDesignStature;
  figure.head_shape = body.shape[Segment::head];
  const double s = figure.scale;
  const SegmentScale& bust = body.shape[Segment::chest];
  const SegmentScale& upper = body.shape[Segment::l_upper_arm];
  const Vector3d& shoulder = figure.at(l_upper_arm);
  const Vector3d& c7 = figure.at(HumanBone::neck);

  Field trunk = loft(figure.at(spine), Vector3d::UnitY(), Vector3d::UnitZ(),
                     scaled(kTorso, s * bust.length, s * bust.width, s * bust.height));
  Field slope = mirror_x(round_cone(c7 + s * Vector3d(0.015, -0.020, -0.004),
                                    shoulder + s * Vector3d(-0.025, -0.004, -0.004), 0.040 * s, 0.040 * s));
  figure.torso = blended({std::move(trunk), std::move(slope)}, 0.060 * s);

  const double arm_scale = s * 0.5 * (upper.width + upper.height);
  figure.arms = mirror_x(loft(shoulder, Vector3d::UnitX(), Vector3d::UnitZ(),
                              along_two(kArm, body.upper_arm_length[0], body.forearm_length[0], arm_scale)));
  figure.skeleton.fingers = finger_bones(body, s);
  figure.hands = mirror_x(hand(body, figure.at(l_hand), *figure.skeleton.fingers, s));

  figure.neck = round_cone(c7 + s * Vector3d(0.0, -0.045, 0.006), figure.in_head(0.0, 0.010, -0.012),
                           0.056 * s, 0.053 * s);
  add_head(figure);

  const Vector3d& hip = figure.at(l_upper_leg);
  const double thigh = hip.y() - figure.at(l_lower_leg).y();
  const double shank = figure.at(l_lower_leg).y() - figure.at(l_foot).y();
  figure.legs = mirror_x(loft(hip, -Vector3d::UnitY(), Vector3d::UnitZ(), along_two(kLeg, thigh, shank, s)));
  figure.feet = mirror_x(foot(figure.at(l_foot), s));
  return figure;
}

}  // namespace telemime
