// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/landmark_learning.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "telemime/body/arm_parts.h"
#include "telemime/evaluation/error_means.h"

namespace telemime {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kHuber = 1.5;  // standard deviations, from which on an error counts linearly
constexpr std::size_t kLeast = 10;
// Medians of the length of an error of unit deviation, in two dimensions and in one.
const double kMedian2 = std::sqrt(2.0 * std::log(2.0));
constexpr double kMedian1 = 0.6745;

// The landmark of the left side, or of the middle, of the same kind.
constexpr std::size_t kind_of(std::size_t landmark) {
  return landmark == 0 ? 0 : landmark - (landmark + 1) % 2;
}
constexpr bool is_right(std::size_t landmark) {
  return kind_of(landmark) != landmark;
}

struct Rotated {
  Matrix3d axes;
  bool known = true;
};

// An arm at rest hangs; the elbow bends about x, toward z.
Rotated arm_axes(const Vector3d& up, const Vector3d& forearm) {
  constexpr double kLeastBend = 0.2;  // sine of it: the axis of a straighter elbow is unknown
  const Vector3d y = up.normalized();
  const Vector3d bend = forearm.normalized() - forearm.normalized().dot(y) * y;
  Rotated r{Matrix3d::Identity(), bend.norm() > kLeastBend};
  const Vector3d z = r.known ? Vector3d(bend.normalized()) : y.unitOrthogonal();
  r.axes << y.cross(z), y, z;
  return r;
}

// Adds to the normal equations of one landmark's offset what an observation says of it.
struct Normal {
  Matrix3d matrix = 1e-6 * Matrix3d::Identity();
  Vector3d gradient = Vector3d::Zero();
  std::size_t count = 0;

  void add(const LearningFrame& frame, std::size_t i, const Vector3d& offset) {
    Matrix3d axes = frame.places[i].axes;
    axes.col(0) *= is_right(i) ? -1.0 : 1.0;
    const Vector3d p = frame.places[i].origin + axes * offset;
    const LandmarkObservation& seen = frame.seen.points[i];
    constexpr double kStep = 1e-5;  // m
    Eigen::Matrix<double, 2, 3> jacobian;
    for (Eigen::Index c = 0; c < 3; ++c) {
      jacobian.col(c) =
          seen.whitening *
          (frame.camera.project(p + kStep * axes.col(c)) - frame.camera.project(p - kStep * axes.col(c))) /
          (2.0 * kStep);
    }
    const Eigen::Vector2d error = landmark_error(seen, frame.camera, p);
    const double weight = 1.0 / std::max(1.0, error.norm() / kHuber);
    matrix += weight * jacobian.transpose() * jacobian;
    gradient -= weight * jacobian.transpose() * error;
    ++count;
  }
};

}  // namespace

LandmarkPlaces actor_places(const ActorKinematics& k) {
  const Body average = make_body({});
  const double stature = average.shape.stature;
  const auto between = [&](Joint a, Joint b) -> Vector3d { return k.joints[b] - k.joints[a]; };
  std::array<Rotated, kSegmentCount> segments;
  const auto set = [&](Segment s, const Rotated& r, double length, double average_length) {
    segments[static_cast<std::size_t>(s)] = {r.axes * (stature * length / average_length), r.known};
  };
  const Matrix3d head = k.camera_from_head.linear();
  set(Segment::chest, {k.camera_from_chest.linear()}, between(Joint::root, Joint::neck).norm(),
      average.neck_from_root.norm());
  set(Segment::head, {head}, between(Joint::head, Joint::head_top).norm(), average.head_top_from_head.norm());
  for (const Side side : {Side::left, Side::right}) {
    const auto i = static_cast<std::size_t>(side);
    const ArmParts& parts = arm_parts(side);
    const Vector3d upper = between(parts.shoulder, parts.elbow);
    const Vector3d fore = between(parts.elbow, parts.wrist);
    const Rotated arm = arm_axes(-upper, fore);
    set(parts.upper_arm, arm, upper.norm(), average.upper_arm_length[i]);
    // The forearm has the same hinge.
    Rotated forearm = arm;
    forearm.axes.col(1) = -fore.normalized();
    forearm.axes.col(2) = forearm.axes.col(0).cross(forearm.axes.col(1));
    set(parts.forearm, forearm, fore.norm(), average.forearm_length[i]);
    // At rest the fingers point down and the thumb forward.
    const Matrix3d own = k.camera_from_hand[i];
    Rotated hand;
    hand.axes << (-own.col(1)).cross(own.col(0)), -own.col(1), own.col(0);
    set(parts.hand, hand, between(parts.wrist, parts.knuckle).norm(), average.hand_length[i]);
  }
  LandmarkPlaces places;
  for (std::size_t i = 0; i < kLandmarkCount; ++i) {
    const LandmarkPoint& point = kLandmarkPoints[i];
    const Rotated& segment = segments[static_cast<std::size_t>(point.axes)];
    places[i] = {k.joints[point.origin], segment.axes, segment.known};
    if (point.axes == Segment::head) {
      // The neck of the model turns with the head: its joint is where the skull base says.
      places[i].origin = k.joints[Joint::head] - segment.axes * (average.head_from_neck / stature);
    }
  }
  return places;
}

std::vector<LearningFrame> learning_frames(const Scene& scene, int step, PersonFinder& finder) {
  std::vector<LearningFrame> frames;
  finder.reset();
  for (int t = 0; t < scene.options.frames; t += step) {
    const auto seen = finder.find(render_frame(scene, t).image, t / kGestureFps);
    if (seen && person_is_visible(scene, t)) {
      frames.push_back(
          {scene.camera, observe(*seen, scene.camera), actor_places(scene_truth(scene, t).bones)});
    }
  }
  return frames;
}

LearnedLandmarks learn_landmarks(std::span<const LearningFrame> frames) {
  LearnedLandmarks learned;
  const auto tells = [](const LearningFrame& frame, std::size_t i) {
    return frame.seen.points[i].seen && frame.places[i].known;
  };
  const auto position = [&](const LearningFrame& frame, std::size_t i, bool by_table = false) -> Vector3d {
    const auto& offset = by_table ? kLandmarkPoints[i].offset : learned.points[i].offset;
    return frame.places[i].origin + frame.places[i].axes * Vector3d(offset.data());
  };
  for (std::size_t kind = 0; kind < kLandmarkCount; ++kind) {
    if (is_right(kind)) {
      learned.points[kind] = learned.points[kind_of(kind)];
      learned.points[kind].offset[0] *= -1.0;
      continue;
    }
    LearnedLandmarks::Point& point = learned.points[kind];
    point.offset = kLandmarkPoints[kind].offset;
    point.sigma = kLandmarkPoints[kind].sigma;
    const std::size_t last = kind == 0 ? 0 : kind + 1;
    constexpr int kRounds = 50;
    for (int round = 0; round < kRounds; ++round) {
      Normal normal;
      for (const LearningFrame& frame : frames) {
        for (std::size_t i = kind; i <= last; ++i) {
          if (tells(frame, i)) {
            normal.add(frame, i, Vector3d(point.offset.data()));
          }
        }
      }
      point.count = normal.count;
      if (normal.count < kLeast) {
        break;
      }
      const Matrix3d covariance = normal.matrix.inverse();
      const Vector3d change = covariance * normal.gradient;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto c = static_cast<Eigen::Index>(axis);
        point.offset[axis] += change[c];
        point.error[axis] = std::sqrt(covariance(c, c));
      }
      if (kind == 0) {
        point.offset[0] = 0.0;  // the nose is in the plane of symmetry
      }
    }
  }
  // Deviations: so that half of the errors are smaller than the median of the distribution.
  for (std::size_t kind = 0; kind < kLandmarkCount; ++kind) {
    std::vector<double> lengths;
    for (const LearningFrame& frame : frames) {
      for (std::size_t i = 0; i < kLandmarkCount; ++i) {
        if (kind_of(i) == kind_of(kind) && tells(frame, i)) {
          lengths.push_back(landmark_error(frame.seen.points[i], frame.camera, position(frame, i)).norm());
        }
      }
    }
    learned.points[kind].sigma *= quantile(std::move(lengths), 0.5).value_or(kMedian2) / kMedian2;
  }
  for (std::size_t bone = 0; bone < kLandmarkBoneCount; ++bone) {
    std::vector<double> errors;
    for (const LearningFrame& frame : frames) {
      LandmarkPositions points;
      for (std::size_t i = 0; i < kLandmarkCount; ++i) {
        points[i] = position(frame, i, kLandmarkPoints[i].source == OffsetSource::anthropometry);
      }
      if (frame.seen.bones[bone].seen) {
        const Vector3d direction = landmark_bones(points)[bone];
        errors.push_back(std::abs(bone_error(frame.seen.bones[bone], frame.seen.ray, direction)));
      }
    }
    learned.bone_sigma[bone] =
        kLandmarkBoneSigma[bone] * quantile(std::move(errors), 0.5).value_or(kMedian1) / kMedian1;
  }
  return learned;
}

}  // namespace telemime
