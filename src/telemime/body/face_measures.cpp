// SPDX-License-Identifier: Apache-2.0
#include "telemime/body/face_measures.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "telemime/body/face_eye.h"

namespace telemime {
namespace {

/// The same points of both sides of a face.
struct SidePoints {
  std::array<std::size_t, 3> upper_lid, lower_lid;  ///< opposite each other
  std::size_t outer, inner;                         ///< corners of the eye
  std::size_t iris;
  std::array<std::size_t, 2> brow_inner, brow_outer;
  std::size_t corner;                                                             ///< of the mouth
  std::array<std::size_t, 2> upper_edge, upper_inside, lower_inside, lower_edge;  ///< of the lips
  std::array<std::size_t, 3> cheek, nostril;
};
constexpr std::array<SidePoints, 2> kSides = {{{.upper_lid = {387, 386, 385},
                                                .lower_lid = {373, 374, 380},
                                                .outer = 263,
                                                .inner = 362,
                                                .iris = kLeftIris,
                                                .brow_inner = {336, 296},
                                                .brow_outer = {300, 293},
                                                .corner = 291,
                                                .upper_edge = {267, 269},
                                                .upper_inside = {312, 311},
                                                .lower_inside = {317, 402},
                                                .lower_edge = {314, 405},
                                                .cheek = {280, 425, 352},
                                                .nostril = {358, 327, 294}},
                                               {.upper_lid = {160, 159, 158},
                                                .lower_lid = {144, 145, 153},
                                                .outer = 33,
                                                .inner = 133,
                                                .iris = kRightIris,
                                                .brow_inner = {107, 66},
                                                .brow_outer = {70, 63},
                                                .corner = 61,
                                                .upper_edge = {37, 39},
                                                .upper_inside = {82, 81},
                                                .lower_inside = {87, 178},
                                                .lower_edge = {84, 181},
                                                .cheek = {50, 205, 123},
                                                .nostril = {129, 98, 64}}}};

/// Which quantile of what was seen is the face at rest, and how far it may be from the canonical face.
struct NeutralRule {
  double quantile;
  double range;
};
constexpr std::array<NeutralRule, kFaceMeasureCount> make_rules() {
  using enum FaceMeasure;
  std::array<NeutralRule, kFaceMeasureCount> rules{};
  const auto set = [&rules](FaceMeasure m, std::size_t count, NeutralRule rule) {
    for (std::size_t i = 0; i < count; ++i) {
      rules[static_cast<std::size_t>(m) + i] = rule;
    }
  };
  // Eyes are open and lips closed more often than not; a mouth at rest is not at either end of its motion.
  set(eye_opening, 2, {0.6, 0.2});
  set(lower_lid, 2, {0.5, 0.12});
  set(iris_left, 2, {0.5, 3.0});
  set(iris_up, 2, {0.5, 3.0});
  set(brow_inner, 2, {0.5, 10.0});
  set(brow_outer, 2, {0.5, 10.0});
  set(corner_up, 2, {0.4, 10.0});
  set(corner_out, 2, {0.4, 8.0});
  set(upper_lip_up, 2, {0.4, 8.0});
  set(lower_lip_up, 2, {0.6, 10.0});
  set(lips_thick, 2, {0.6, 10.0});
  set(cheek_up, 2, {0.4, 12.0});
  set(nostril_up, 2, {0.4, 8.0});
  set(side_gap, 2, {0.25, 3.0});
  set(chin_down, 1, {0.25, 14.0});
  set(chin_left, 1, {0.5, 6.0});
  set(lip_gap, 1, {0.25, 3.0});
  set(mouth_width, 1, {0.5, 14.0});
  set(mouth_left, 1, {0.5, 6.0});
  set(upper_lip_thick, 1, {0.6, 6.0});
  set(lower_lip_thick, 1, {0.6, 6.0});
  set(lower_lip_mid_up, 1, {0.6, 12.0});
  return rules;
}
constexpr std::array<NeutralRule, kFaceMeasureCount> kRules = make_rules();

}  // namespace

FaceMeasures measure_face(const FacePoints& points, const HeadFit& fit) {
  using enum FaceMeasure;
  FaceMeasures m;
  const auto at = [&](std::size_t i) { return fit.in_head(points[i]); };
  const auto mean = [&](const auto& list) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const std::size_t i : list) {
      sum += at(i);
    }
    return Eigen::Vector3d(sum / static_cast<double>(list.size()));
  };
  using List = std::initializer_list<std::size_t>;
  const Eigen::Vector3d nose = mean(List{1, 2, 4, 94});
  const Eigen::Vector3d bridge = mean(List{168, 6, 197});
  const Eigen::Vector3d chin = mean(List{152, 148, 377});
  const Eigen::Vector3d left_corner = mean(List{263, 362});
  const double eye_line = 0.5 * (left_corner + mean(List{33, 133})).y();
  for (const Side side : {Side::left, Side::right}) {
    const SidePoints& p = kSides[static_cast<std::size_t>(side)];
    const double out = side == Side::left ? 1.0 : -1.0;
    const auto set = [&](FaceMeasure which, double value) {
      m.at[static_cast<std::size_t>(which) + static_cast<std::size_t>(side)] = value;
    };
    // The eye.
    const Eigen::Vector3d outer = at(p.outer), inner = at(p.inner);
    const double width = std::max((outer - inner).norm(), 1.0);
    double opening = 0.0;
    for (std::size_t k = 0; k < p.upper_lid.size(); ++k) {
      opening += (at(p.upper_lid[k]) - at(p.lower_lid[k])).norm() / static_cast<double>(p.upper_lid.size());
    }
    const Eigen::Vector3d middle = 0.5 * (outer + inner);
    set(eye_opening, opening / width);
    set(lower_lid, (middle - mean(p.lower_lid)).y() / width);
    // The iris is seen in the picture alone: its depth is that of a ball in the eye.
    const Eigen::Vector3d ball = middle + Eigen::Vector3d(0.0, 0.0, kEyeball - kIrisBulge);
    Eigen::Vector3d offset = fit.rotation * (at(p.iris) - ball);
    const double across = offset.head<2>().squaredNorm();
    offset.z() = -std::sqrt(std::max(kEyeball * kEyeball - across, 0.0));
    const Eigen::Vector3d iris = fit.rotation.conjugate() * offset;
    set(iris_left, iris.x());
    set(iris_up, -iris.y());
    // The brows.
    set(brow_inner, eye_line - mean(p.brow_inner).y());
    set(brow_outer, eye_line - mean(p.brow_outer).y());
    // The mouth.
    const Eigen::Vector3d corner = at(p.corner);
    const Eigen::Vector3d upper = mean(p.upper_edge), lower = mean(p.lower_edge);
    set(corner_up, nose.y() - corner.y());
    set(corner_out, out * (corner.x() - nose.x()));
    set(upper_lip_up, nose.y() - upper.y());
    set(lower_lip_up, chin.y() - lower.y());
    set(lips_thick, (mean(p.upper_inside) - upper).norm() + (lower - mean(p.lower_inside)).norm());
    set(side_gap, (mean(p.upper_inside) - mean(p.lower_inside)).norm());
    set(cheek_up, nose.y() - mean(p.cheek).y());
    set(nostril_up, bridge.y() - mean(p.nostril).y());
  }
  const auto set = [&m](FaceMeasure which, double value) { m.at[static_cast<std::size_t>(which)] = value; };
  const Eigen::Vector3d lips = mean(List{0, 13, 14, 17});
  set(chin_down, chin.y() - nose.y());
  set(chin_left, chin.x() - nose.x());
  set(lip_gap, (mean(List{82, 13, 312}) - mean(List{87, 14, 317})).norm());
  set(mouth_width, (at(61) - at(291)).norm());
  set(mouth_left, lips.x() - nose.x());
  set(upper_lip_thick, (at(0) - at(13)).norm());
  set(lower_lip_thick, (at(17) - at(14)).norm());
  set(lower_lip_mid_up, nose.y() - at(17).y());
  return m;
}

NeutralFace::NeutralFace() {
  front_.neutral = measure_face(canonical_face(), HeadFit{});
  sides_.fill(front_);
}

bool NeutralFace::View::add(const FaceMeasures& sample, double time) {
  constexpr double kFirstInterval = 0.1;  // s
  constexpr double kLastInterval = 3.2;   // s
  constexpr std::size_t kMost = 64;
  if (interval > 0.0 && time < next) {
    return false;
  }
  if (interval == 0.0) {
    interval = kFirstInterval;
  } else if (seen.size() == kMost && interval < kLastInterval) {
    // Every second sample goes; those that are kept are farther apart in time.
    for (std::size_t i = 0; i < kMost / 2; ++i) {
      seen[i] = seen[2 * i + 1];
    }
    seen.resize(kMost / 2);
    interval *= 2.0;
  } else if (seen.size() == kMost) {
    seen.erase(seen.begin());
  }
  next = time + interval;
  seen.push_back(sample);
  return true;
}

void NeutralFace::View::update(const FaceMeasures& prior, std::size_t copies) {
  constexpr std::size_t kSeenPerCopy = 4;
  const std::size_t left = copies - std::min(copies, seen.size() / kSeenPerCopy);
  std::vector<double> values;
  for (std::size_t m = 0; m < kFaceMeasureCount; ++m) {
    values.assign(left, prior.at[m]);
    for (const FaceMeasures& each : seen) {
      values.push_back(each.at[m]);
    }
    if (values.empty()) {
      return;
    }
    const auto middle =
        values.begin() + static_cast<std::ptrdiff_t>(
                             std::floor(kRules[m].quantile * static_cast<double>(values.size() - 1) + 0.5));
    std::nth_element(values.begin(), middle, values.end());
    neutral.at[m] = std::clamp(*middle, prior.at[m] - kRules[m].range, prior.at[m] + kRules[m].range);
  }
}

void NeutralFace::learn(const FaceMeasures& seen, double yaw, double time) {
  constexpr double kFront = 0.44;        // 25 degrees
  constexpr double kFarthest = 1.2;      // 69 degrees
  constexpr std::size_t kCanonical = 2;  // samples that the canonical face counts as
  constexpr std::size_t kOwnFront = 8;   // those that the front counts as for the sides
  static const FaceMeasures canonical = measure_face(canonical_face(), HeadFit{});
  if (!(std::abs(yaw) < kFarthest)) {
    return;
  }
  View& view = std::abs(yaw) < kFront ? front_ : sides_[yaw > 0.0 ? 0 : 1];
  if (!view.add(seen, time)) {
    return;
  }
  if (&view == &front_) {
    front_.update(canonical, kCanonical);
  }
  for (View& side : sides_) {
    side.update(front_.neutral, kOwnFront);
  }
}

FaceMeasures NeutralFace::measures(double yaw) const {
  constexpr double kFront = 0.3;  // 17 degrees
  constexpr double kSide = 0.7;   // 40 degrees
  const double share = std::clamp((std::abs(yaw) - kFront) / (kSide - kFront), 0.0, 1.0);
  FaceMeasures result = front_.neutral;
  const FaceMeasures& side = sides_[yaw > 0.0 ? 0 : 1].neutral;
  for (std::size_t m = 0; m < kFaceMeasureCount; ++m) {
    result.at[m] += share * (side.at[m] - result.at[m]);
  }
  return result;
}

}  // namespace telemime
