// SPDX-License-Identifier: Apache-2.0
#include "telemime/body/face_expression.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "telemime/body/face_eye.h"
#include "telemime/body/rotations.h"

namespace telemime {
namespace {

constexpr double kDegree = 0.017453292519943295;

// 0 below `from`, 1 above `to`, linear between; `from` may be the larger one. Not finite: 0.
double ramp(double value, double from, double to) {
  const double share = (value - from) / (to - from);
  return std::isfinite(share) ? std::clamp(share, 0.0, 1.0) : 0.0;
}

double finite(double value) {
  return std::isfinite(value) ? value : 0.0;
}

// The same coefficient of both sides.
struct SidePair {
  Expression left, right;
  Expression operator[](Side side) const { return side == Side::left ? left : right; }
};

using enum Expression;
constexpr SidePair kBrowDown{brow_down_left, brow_down_right};
constexpr SidePair kBrowOuterUp{brow_outer_up_left, brow_outer_up_right};
constexpr SidePair kCheekSquint{cheek_squint_left, cheek_squint_right};
constexpr SidePair kBlink{eye_blink_left, eye_blink_right};
constexpr SidePair kLookDown{eye_look_down_left, eye_look_down_right};
constexpr SidePair kLookIn{eye_look_in_left, eye_look_in_right};
constexpr SidePair kLookOut{eye_look_out_left, eye_look_out_right};
constexpr SidePair kLookUp{eye_look_up_left, eye_look_up_right};
constexpr SidePair kSquint{eye_squint_left, eye_squint_right};
constexpr SidePair kWide{eye_wide_left, eye_wide_right};
constexpr SidePair kFrown{mouth_frown_left, mouth_frown_right};
constexpr SidePair kLowerDown{mouth_lower_down_left, mouth_lower_down_right};
constexpr SidePair kPress{mouth_press_left, mouth_press_right};
constexpr SidePair kSmile{mouth_smile_left, mouth_smile_right};
constexpr SidePair kStretch{mouth_stretch_left, mouth_stretch_right};
constexpr SidePair kUpperUp{mouth_upper_up_left, mouth_upper_up_right};
constexpr SidePair kSneer{nose_sneer_left, nose_sneer_right};
// Those that one side can do without the other.
constexpr SidePair kSided[] = {kBrowDown,  kBrowOuterUp, kCheekSquint, kBlink,   kSquint,  kWide, kFrown,
                               kLowerDown, kPress,       kSmile,       kStretch, kUpperUp, kSneer};

// Each measure less the same one at rest.
class Change {
 public:
  Change(const FaceMeasures& seen, const FaceMeasures& neutral) : seen_(seen), neutral_(neutral) {}
  double of(FaceMeasure m, Side side) const { return finite(seen_.of(m, side) - neutral_.of(m, side)); }
  double of(FaceMeasure m) const { return of(m, Side::left); }
  /// The measure as a share of the one at rest.
  double share(FaceMeasure m, Side side) const {
    const double share = seen_.of(m, side) / neutral_.of(m, side);
    return std::isfinite(share) ? share : 1.0;
  }
  double share(FaceMeasure m) const { return share(m, Side::left); }

 private:
  const FaceMeasures& seen_;
  const FaceMeasures& neutral_;
};

// To the person's left, and up; rad.
Eigen::Vector2d gaze_of(const Change& change, Side side) {
  const auto angle = [](double offset) { return std::asin(std::clamp(offset / kEyeball, -1.0, 1.0)); };
  return {angle(change.of(FaceMeasure::iris_left, side)), angle(change.of(FaceMeasure::iris_up, side))};
}

void set_eye(const Change& change, Side side, FaceMotion& face) {
  using enum FaceMeasure;
  const Eigen::Vector2d gaze = gaze_of(change, side);
  const double to_out = side == Side::left ? gaze.x() : -gaze.x();
  constexpr double kAside = 35.0 * kDegree;
  constexpr double kVertical = 30.0 * kDegree;
  face[kLookOut[side]] = ramp(to_out, 0.0, kAside);
  face[kLookIn[side]] = ramp(-to_out, 0.0, kAside);
  face[kLookUp[side]] = ramp(gaze.y(), 0.0, kVertical);
  face[kLookDown[side]] = ramp(-gaze.y(), 0.0, kVertical);
  // The upper lid follows the eye downwards without closing it.
  const double opening = change.share(eye_opening, side) + 0.25 * face[kLookDown[side]];
  face[kBlink[side]] = ramp(opening, 0.8, 0.35);
  face[kWide[side]] = ramp(opening, 1.15, 1.5);
  face[kSquint[side]] = ramp(change.of(lower_lid, side), 0.01, 0.07) * ramp(opening, 0.25, 0.5);
}

void set_brow(const Change& change, Side side, FaceMotion& face) {
  using enum FaceMeasure;
  const double inner = change.of(brow_inner, side);
  face[kBrowDown[side]] = ramp(-inner, 0.5, 5.0);
  face[kBrowOuterUp[side]] = ramp(change.of(brow_outer, side), 0.7, 7.0);
  face[brow_inner_up] += 0.5 * ramp(inner, 0.7, 7.0);
  face[kSneer[side]] = ramp(change.of(nostril_up, side), 1.0, 5.0);
  face[kCheekSquint[side]] = ramp(change.of(cheek_up, side), 1.5, 7.0);
}

// How far the lips are to the person's left of where the jaw takes them, mm.
double lips_aside(const Change& change) {
  return change.of(FaceMeasure::mouth_left) - 0.5 * change.of(FaceMeasure::chin_left);
}

// How far the lips are apart on a side, from closed to 1.
double apart(const Change& change, Side side) {
  return ramp(change.of(FaceMeasure::side_gap, side), 0.7, 4.0);
}

void set_jaw_and_lips(const Change& change, FaceMotion& face) {
  using enum FaceMeasure;
  const double chin = change.of(chin_down);
  face[jaw_open] = ramp(chin, 1.0, 26.0);
  face[mouth_close] = std::min(face[jaw_open], ramp(chin - change.of(lip_gap), 4.0, 24.0));
  const double aside = change.of(chin_left);
  face[jaw_left] = ramp(aside, 1.0, 9.0);
  face[jaw_right] = ramp(-aside, 1.0, 9.0);
  face[Expression::mouth_left] = ramp(lips_aside(change), 1.0, 9.0);
  face[mouth_right] = ramp(-lips_aside(change), 1.0, 9.0);
  // The mouth becomes narrower when the jaw opens, too.
  const double narrow = ramp(change.share(mouth_width) + 0.15 * face[jaw_open], 0.95, 0.65);
  const double round = ramp(change.of(lip_gap), 1.0, 8.0);
  face[mouth_funnel] = narrow * round;
  face[mouth_pucker] = narrow * (1.0 - round);
  face[mouth_roll_upper] = ramp(change.share(upper_lip_thick), 0.8, 0.3);
  face[mouth_roll_lower] = ramp(change.share(lower_lip_thick), 0.8, 0.3);
  // Closed lips that go up.
  const double closed = 1.0 - std::max(apart(change, Side::left), apart(change, Side::right));
  const double upper = 0.5 * (change.of(upper_lip_up, Side::left) + change.of(upper_lip_up, Side::right));
  face[mouth_shrug_upper] = closed * ramp(upper, 1.0, 6.0);
  face[mouth_shrug_lower] = closed * ramp(change.of(lower_lip_mid_up), 1.0, 7.0);
}

void set_mouth_side(const Change& change, Side side, FaceMotion& face) {
  using enum FaceMeasure;
  const double sign = side == Side::left ? 1.0 : -1.0;
  // The corner against where the jaw and the middle of the lips take it.
  const double up = change.of(corner_up, side) + 0.25 * std::max(change.of(chin_down), 0.0);
  const double out = change.of(corner_out, side) - sign * lips_aside(change);
  const double open = apart(change, side);
  face[kSmile[side]] = ramp(0.8 * up + 0.6 * std::max(out, 0.0), 1.0, 9.0) * ramp(up, 0.0, 2.0);
  face[kFrown[side]] = ramp(-up, 1.0, 7.0);
  face[kStretch[side]] = ramp(out, 1.0, 9.0) * ramp(up, 4.0, 1.0);
  const double lip = change.of(upper_lip_up, side) - 0.3 * std::max(up, 0.0);
  face[kUpperUp[side]] = open * ramp(lip, 0.7, 6.0);
  face[kLowerDown[side]] = open * ramp(-change.of(lower_lip_up, side), 0.7, 6.0);
  face[kPress[side]] = (1.0 - open) * ramp(change.share(lips_thick, side), 0.65, 0.3);
}

// A side that is turned away does what the other one does.
void cover_hidden_side(double left_seen, double right_seen, FaceMotion& face) {
  for (const SidePair& pair : kSided) {
    const double left = face[pair.left];
    const double right = face[pair.right];
    face[pair.left] = left_seen * left + (1.0 - left_seen) * right;
    face[pair.right] = right_seen * right + (1.0 - right_seen) * left;
  }
  const auto cover_gaze = [&face](const SidePair& outward, const SidePair& inward, Side hidden, double seen) {
    const Side other = hidden == Side::left ? Side::right : Side::left;
    // Both eyes look to the same side.
    face[outward[hidden]] = seen * face[outward[hidden]] + (1.0 - seen) * face[inward[other]];
    face[inward[hidden]] = seen * face[inward[hidden]] + (1.0 - seen) * face[outward[other]];
    for (const SidePair& pair : {kLookUp, kLookDown}) {
      face[pair[hidden]] = seen * face[pair[hidden]] + (1.0 - seen) * face[pair[other]];
    }
  };
  cover_gaze(kLookOut, kLookIn, left_seen < right_seen ? Side::left : Side::right,
             std::min(left_seen, right_seen));
}

// The same expression of the other side; itself if it has no side.
std::size_t other_side(std::size_t expression) {
  constexpr std::string_view kLeftEnd = "Left";
  constexpr std::string_view kRightEnd = "Right";
  const std::string_view name = kExpressionNames[expression];
  std::string other(name);
  if (name.ends_with(kLeftEnd)) {
    other.replace(name.size() - kLeftEnd.size(), kLeftEnd.size(), kRightEnd);
  } else if (name.ends_with(kRightEnd)) {
    other.replace(name.size() - kRightEnd.size(), kRightEnd.size(), kLeftEnd);
  }
  return static_cast<std::size_t>(std::find(kExpressionNames.begin(), kExpressionNames.end(), other) -
                                  kExpressionNames.begin());
}

}  // namespace

FaceMotion expression_of(const FaceMeasures& seen, const FaceMeasures& neutral) {
  const Change change(seen, neutral);
  FaceMotion face;
  face.gaze = 0.5 * (gaze_of(change, Side::left) + gaze_of(change, Side::right));
  set_jaw_and_lips(change, face);
  for (const Side side : {Side::left, Side::right}) {
    set_eye(change, side, face);
    set_brow(change, side, face);
    set_mouth_side(change, side, face);
  }
  return face;
}

FaceMotion face_motion(const FacePoints& points, double presence, const Camera& camera, double time,
                       NeutralFace& neutral) {
  const HeadFit fit = fit_head(points);
  constexpr double kWorstFit = 25.0;  // mm
  if (!(fit.residual < kWorstFit) || !(presence >= 0.0 && presence <= 1.0)) {
    return {};
  }
  // Of small faces the head is seen, but not what its parts do.
  constexpr double kPupils = 63.0;  // mm apart
  const double size = kPupils * fit.scale;
  const double confidence =
      ramp(presence, 0.5, 0.9) * ramp(size, 6.0, 16.0) * ramp(fit.residual, kWorstFit, 10.0);
  const double detail = confidence * ramp(size, 10.0, 36.0);
  const FaceMeasures seen = measure_face(points, fit);
  const Eigen::Vector3d nose = fit.rotation * -Eigen::Vector3d::UnitZ();
  const double yaw = std::atan2(nose.x(), -nose.z());
  constexpr double kNodding = 0.5;  // sine of the pitch
  constexpr double kClear = 0.7;
  if (std::abs(nose.y()) < kNodding && detail > kClear) {
    neutral.learn(seen, yaw, time);
  }
  const FaceMeasures rest = neutral.measures(yaw);
  FaceMotion face = expression_of(seen, rest);
  face.confidence = confidence;
  // A side disappears while the head turns from 60 to 75 degrees.
  constexpr double kSeen = 60.0 * kDegree;
  constexpr double kHidden = 75.0 * kDegree;
  const double left_seen = ramp(yaw, kHidden, kSeen);
  const double right_seen = ramp(-yaw, kHidden, kSeen);
  face.gaze =
      (left_seen * gaze_of({seen, rest}, Side::left) + right_seen * gaze_of({seen, rest}, Side::right)) /
      (left_seen + right_seen);
  cover_hidden_side(left_seen, right_seen, face);
  // Two eyes that are seen look equally far up. Where the network only guesses, behind dark glasses, they do
  // not.
  const double apart =
      std::abs(gaze_of({seen, rest}, Side::left).y() - gaze_of({seen, rest}, Side::right).y());
  const double guessed = std::min(left_seen, right_seen) * ramp(apart, 8.0 * kDegree, 20.0 * kDegree);
  face.gaze *= 1.0 - guessed;
  for (const auto* const looks : {&kLookOut, &kLookIn, &kLookUp, &kLookDown}) {
    for (const Side side : {Side::left, Side::right}) {
      face[(*looks)[side]] *= 1.0 - guessed;
    }
  }
  // The points are a parallel projection along the ray to the head.
  const Eigen::Vector3d ray = camera.ray(fit.translation.head<2>());
  face.head = rotation_between(Eigen::Vector3d::UnitZ(), ray) * fit.rotation;
  face.detail = detail;
  face.gaze *= detail;
  for (double& value : face.expressions) {
    value *= detail;
  }
  return face;
}

FaceMotion mean_of_looks(const FaceMotion& first, const FaceMotion& second) {
  if (!(first.confidence > 0.0) || !(second.confidence > 0.0)) {
    return first.confidence > 0.0 ? first : second;
  }
  FaceMotion face = first;
  face.confidence = 0.5 * (first.confidence + second.confidence);
  face.head = first.head.slerp(0.5, second.head);
  face.gaze = 0.5 * (first.gaze + second.gaze);
  face.noise.gaze = (first.gaze - second.gaze).norm();
  for (std::size_t i = 0; i < kExpressionCount; ++i) {
    face.expressions[i] = 0.5 * (first.expressions[i] + second.expressions[i]);
    face.noise.expressions[i] = std::abs(first.expressions[i] - second.expressions[i]);
  }
  return face;
}

FaceMotion mirrored(const FaceMotion& face) {
  FaceMotion m = face;
  m.head = Eigen::Quaterniond(face.head.w(), face.head.x(), -face.head.y(), -face.head.z());
  m.gaze.x() = -face.gaze.x();
  for (std::size_t i = 0; i < kExpressionCount; ++i) {
    m.expressions[other_side(i)] = face.expressions[i];
    m.noise.expressions[other_side(i)] = face.noise.expressions[i];
  }
  return m;
}

}  // namespace telemime
