// SPDX-License-Identifier: Apache-2.0
#include "telemime/search/landmark_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "telemime/body/arm_flips.h"
#include "telemime/body/arm_ik.h"
#include "telemime/body/arm_parts.h"
#include "telemime/body/kinematic_rates.h"
#include "telemime/body/rotations.h"

namespace telemime {
namespace {

// Standard deviations of the pose's numbers about the likeliest pose, m and rad: wide, so that the landmarks
// decide what they see.
PoseVector prior_deviations() {
  PoseVector s;
  s << 2.0, 2.0, 2.0,                // root
      0.6, 0.2, 0.3,                 // torsion, roll and tilt of the root
      0.4, 0.8, 0.4,                 // roll, torsion and tilt of the neck
      1.2, 1.2, 1.0, 1.2, 1.2, 1.0,  // shoulders
      1.2, 1.2,                      // elbows
      0.4, 0.8, 0.3, 0.4, 0.8, 0.3;  // wrists
  return s;
}

constexpr Eigen::Index kTorsion = 3;  // of the root: a person may turn all the way round
constexpr std::size_t kFollowed = 4;
constexpr double kMostFollowed = 8.0;  // that one followed joint costs, however far it is from its prediction
constexpr std::array<Joint, kFollowed> kFollowedJoints = {Joint::l_elbow, Joint::r_elbow, Joint::l_wrist,
                                                          Joint::r_wrist};
constexpr Eigen::Index kResiduals = 2 * static_cast<Eigen::Index>(kLandmarkCount) +
                                    static_cast<Eigen::Index>(kLandmarkBoneCount) +
                                    static_cast<Eigen::Index>(kPoseSize) + 3 * kFollowed;
using Residuals = Eigen::Matrix<double, kResiduals, 1>;
using Jacobian = Eigen::Matrix<double, kResiduals, static_cast<Eigen::Index>(kPoseSize)>;

// The problem of one fit: the errors of a pose, in standard deviations.
struct Problem {
  const Body& body;
  const Camera& camera;
  const BodyLandmarks& landmarks;
  const LandmarkPrior& prior;
  PoseVector mean = prior.pose.vector();
  PoseVector deviations = prior_deviations();
  JointPositions followed = forward_kinematics(body, prior.pose).joints;

  // Errors of a pose.
  Residuals operator()(const PoseVector& x) const {
    Residuals r;
    const Kinematics k = forward_kinematics(body, Pose::from_vector(x));
    const LandmarkPositions points = landmark_positions(body, k);
    Eigen::Index at = 0;
    for (std::size_t i = 0; i < kLandmarkCount; ++i, at += 2) {
      r.segment<2>(at) = landmark_error(landmarks.points[i], camera, points[i]);
    }
    const auto bones = landmark_bones(points);
    for (std::size_t i = 0; i < kLandmarkBoneCount; ++i) {
      r[at++] = bone_error(landmarks.bones[i], landmarks.ray, bones[i]);
    }
    PoseVector change = x - mean;
    change[kTorsion] = wrap_angle(change[kTorsion]);
    r.segment<static_cast<Eigen::Index>(kPoseSize)>(at) = change.cwiseQuotient(deviations);
    at += static_cast<Eigen::Index>(kPoseSize);
    for (const Joint j : kFollowedJoints) {
      const Eigen::Vector3d way = k.joints[j] - followed[j];
      r.segment<3>(at) = prior.following > 0.0 ? Eigen::Vector3d(way / prior.following)
                                               : Eigen::Vector3d(Eigen::Vector3d::Zero());
      at += 3;
    }
    return r;
  }

  // Their derivatives.
  Jacobian jacobian(const PoseVector& x) const {
    const Pose pose = Pose::from_vector(x);
    const Kinematics k = forward_kinematics(body, pose);
    const LandmarkPositions points = landmark_positions(body, k);
    const auto bones = landmark_bones(points);
    const auto rates = kinematic_rates(body, pose, k);
    Jacobian all = Jacobian::Zero();
    for (std::size_t n = 0; n < kPoseSize; ++n) {
      auto column = all.col(static_cast<Eigen::Index>(n));
      const LandmarkPositions velocities = landmark_velocities(points, k, rates[n]);
      Eigen::Index at = 0;
      for (std::size_t i = 0; i < kLandmarkCount; ++i, at += 2) {
        if (!velocities[i].isZero(0.0)) {
          column.segment<2>(at) = landmark_error_rate(landmarks.points[i], camera, points[i], velocities[i]);
        }
      }
      const auto changes = landmark_bones(velocities);
      for (std::size_t i = 0; i < kLandmarkBoneCount; ++i) {
        column[at++] = bone_error_rate(landmarks.bones[i], landmarks.ray, bones[i], changes[i]);
      }
      column[at + static_cast<Eigen::Index>(n)] = 1.0 / deviations[static_cast<Eigen::Index>(n)];
      at += static_cast<Eigen::Index>(kPoseSize);
      if (prior.following > 0.0) {
        for (const Joint j : kFollowedJoints) {
          column.segment<3>(at) = rates[n].joints[j] / prior.following;
          at += 3;
        }
      }
    }
    return all;
  }
};

// Calls f(first row, rows, most) for each group of errors that may hold an outlier.
template <typename F>
void each_robust(const F& f) {
  Eigen::Index at = 0;
  for (std::size_t i = 0; i < kLandmarkCount; ++i, at += 2) {
    f(at, 2, kMostLandmark);
  }
  for (std::size_t i = 0; i < kLandmarkBoneCount; ++i, ++at) {
    f(at, 1, kMostBone);
  }
  at += static_cast<Eigen::Index>(kPoseSize);
  for (std::size_t i = 0; i < kFollowed; ++i, at += 3) {
    f(at, 3, kMostFollowed);
  }
}

double cost_of(const Residuals& r) {
  double sum = r.squaredNorm();
  each_robust([&](Eigen::Index at, Eigen::Index rows, double most) {
    const double squared = r.segment(at, rows).squaredNorm();
    sum += robust_square(squared, most) - squared;
  });
  return 0.5 * sum;
}

// Square roots of the derivatives of the robust squares: the weights of the rows.
Residuals row_weights(const Residuals& r) {
  Residuals w = Residuals::Ones();
  each_robust([&](Eigen::Index at, Eigen::Index rows, double most) {
    w.segment(at, rows).setConstant(1.0 / (1.0 + r.segment(at, rows).squaredNorm() / most));
  });
  return w;
}

// Levenberg-Marquardt.
constexpr int kMostSteps = 12;
constexpr int kMostDampings = 6;        // of one step, each with more damping
constexpr double kEnough = 1e-3;        // relative gain of a step below which the fit has converged
constexpr double kFirstDamping = 1e-3;  // relative to the diagonal
constexpr double kLeastDamping = 1e-6;
constexpr double kLessDamping = 0.2;  // factor after a step that gained
constexpr double kMoreDamping = 10.0;
// The first pose of a person.
constexpr double kSteepest =
    0.95;  // largest slope of a bone that is believed, sine of its angle to the image
constexpr double kFirstTurn = 0.7;  // rad, of the trunk to either side

// The likeliest pose of a person of whom nothing is known: upright, facing the camera, arms bent a little.
Pose neutral_pose() {
  Pose pose;
  set_arm_angles(pose, Side::left, {.flexion = -0.3, .twisting = -0.3, .abduct = 0.3, .elbow = -0.9});
  set_arm_angles(pose, Side::right, {.flexion = -0.3, .twisting = 0.3, .abduct = -0.3, .elbow = -0.9});
  return pose;
}

bool seen(const BodyLandmarks& landmarks, Landmark l) {
  return landmarks.points[static_cast<std::size_t>(l)].seen;
}

const Eigen::Vector2d& pixel(const BodyLandmarks& landmarks, Landmark l) {
  return landmarks.points[static_cast<std::size_t>(l)].pixel;
}

// Distance of the person (m) from the pairs of landmarks that are seen: the pair that looks largest is the
// least foreshortened, so the smallest distance counts.
std::optional<double> distance_from_pairs(const Body& body, const Camera& camera,
                                          const BodyLandmarks& landmarks) {
  constexpr std::array<std::pair<Landmark, Landmark>, 3> kPairs = {
      {{Landmark::l_shoulder, Landmark::r_shoulder},
       {Landmark::l_eye, Landmark::r_eye},
       {Landmark::l_ear, Landmark::r_ear}}};
  const LandmarkPositions rest = landmark_positions(body, forward_kinematics(body, Pose{}));
  std::optional<double> nearest;
  for (const auto& [a, b] : kPairs) {
    const double pixels = (pixel(landmarks, a) - pixel(landmarks, b)).norm();
    if (seen(landmarks, a) && seen(landmarks, b) && pixels > 1.0) {
      const double metres = (rest[static_cast<std::size_t>(a)] - rest[static_cast<std::size_t>(b)]).norm();
      const double z = camera.distance_of(metres, pixels);
      nearest = std::min(z, nearest.value_or(z));
    }
  }
  return nearest;
}

}  // namespace

LandmarkFit fit_to_landmarks(const Body& body, const Camera& camera, const BodyLandmarks& landmarks,
                             const LandmarkPrior& prior, const Pose& start, const JointLimits& limits) {
  const Problem problem{body, camera, landmarks, prior};
  PoseVector x = limits.clamp(start).vector();
  Residuals r = problem(x);
  double cost = cost_of(r);
  double damping = kFirstDamping;
  for (int step = 0; step < kMostSteps; ++step) {
    // Linearise about the pose.
    const Residuals w = row_weights(r);
    const Jacobian weighted = w.asDiagonal() * problem.jacobian(x);
    Eigen::Matrix<double, kPoseSize, kPoseSize> normal;  // only its lower half is read
    normal.triangularView<Eigen::Lower>() = weighted.transpose().lazyProduct(weighted);
    const PoseVector gradient = weighted.transpose() * w.cwiseProduct(r);
    // Damp more until the step gains something.
    bool gained = false;
    const double before = cost;
    for (int attempt = 0; attempt < kMostDampings && !gained; ++attempt) {
      Eigen::Matrix<double, kPoseSize, kPoseSize> damped = normal;
      damped.diagonal() *= 1.0 + damping;
      const PoseVector change = damped.ldlt().solve(gradient);
      const PoseVector candidate = limits.clamp(Pose::from_vector(x - change)).vector();
      const Residuals errors = problem(candidate);
      const double new_cost = cost_of(errors);
      gained = new_cost < cost;
      if (gained) {
        x = candidate;
        r = errors;
        cost = new_cost;
        damping = std::max(kLeastDamping, kLessDamping * damping);
      } else {
        damping *= kMoreDamping;
      }
    }
    if (!gained || before - cost < kEnough * before) {
      break;
    }
  }
  return {Pose::from_vector(x), cost};
}

std::optional<Pose> pose_from_landmarks(const Body& body, const Camera& camera,
                                        const BodyLandmarks& landmarks, const JointLimits& limits) {
  const auto z = distance_from_pairs(body, camera, landmarks);
  if (!z) {
    return std::nullopt;
  }
  // The trunk where shoulders or head are seen.
  LandmarkPrior prior{neutral_pose()};
  Pose& pose = prior.pose;
  pose.root = Eigen::Vector3d(0.0, 0.0, *z);
  const LandmarkPositions points = landmark_positions(body, forward_kinematics(body, pose));
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();
  int count = 0;
  for (const Landmark l : {Landmark::nose, Landmark::l_shoulder, Landmark::r_shoulder}) {
    if (seen(landmarks, l)) {
      const Eigen::Vector3d& at = points[static_cast<std::size_t>(l)];
      shift += camera.ray(pixel(landmarks, l)) * at.z() - at;
      ++count;
    }
  }
  if (count > 0) {
    pose.root += shift / count;
  }
  // The arms along their lines in the picture, with the slopes for which the network's reports stand.
  const auto bone_along = [&](Landmark from, Landmark to,
                              LandmarkBone bone) -> std::optional<Eigen::Vector3d> {
    if (!seen(landmarks, from) || !seen(landmarks, to)) {
      return std::nullopt;
    }
    const Eigen::Vector2d in_picture = pixel(landmarks, to) - pixel(landmarks, from);
    const BoneObservation& slope = landmarks.bones[static_cast<std::size_t>(bone)];
    const double likely = (slope.along - slope.response.offset) / slope.response.gain;
    const double along = slope.seen ? std::clamp(likely, -kSteepest, kSteepest) : 0.0;
    const double across = std::sqrt(1.0 - along * along);
    Eigen::Vector3d direction(in_picture.x(), in_picture.y(), 0.0);
    direction.normalize();
    return across * direction + Eigen::Vector3d(0.0, 0.0, along);
  };
  for (const Side side : {Side::left, Side::right}) {
    const bool left = side == Side::left;
    const auto upper = bone_along(left ? Landmark::l_shoulder : Landmark::r_shoulder,
                                  left ? Landmark::l_elbow : Landmark::r_elbow,
                                  left ? LandmarkBone::l_upper_arm : LandmarkBone::r_upper_arm);
    const auto fore =
        bone_along(left ? Landmark::l_elbow : Landmark::r_elbow, left ? Landmark::l_wrist : Landmark::r_wrist,
                   left ? LandmarkBone::l_forearm : LandmarkBone::r_forearm);
    if (upper && fore) {
      const Eigen::Vector3d shoulder = forward_kinematics(body, pose).joints[arm_parts(side).shoulder];
      const auto i = static_cast<std::size_t>(side);
      const Eigen::Vector3d elbow = shoulder + body.upper_arm_length[i] * *upper;
      set_arm_angles(pose, side,
                     arm_through(body, pose, side, elbow, elbow + body.forearm_length[i] * *fore, limits));
    }
  }
  // The trunk is turned towards either side at first: near profile a fit from the front need not converge.
  const Pose start = limits.clamp(pose);
  LandmarkFit best{start, std::numeric_limits<double>::infinity()};
  prior.pose = neutral_pose();
  prior.pose.root = start.root;
  for (const double turn : {0.0, -kFirstTurn, kFirstTurn}) {
    Pose turned = start;
    turned[Angle::root_torsion] = turn;
    const LandmarkFit fit = fit_to_landmarks(body, camera, landmarks, prior, limits.clamp(turned), limits);
    best = fit.cost < best.cost ? fit : best;
  }
  return best.pose;
}

std::vector<LandmarkFit> landmark_proposals(const Body& body, const Camera& camera,
                                            const BodyLandmarks& landmarks, const LandmarkPrior& prior,
                                            const JointLimits& limits, std::size_t most) {
  constexpr double kApart = 0.05;  // m, of an elbow or a wrist: nearer poses are the same
  const LandmarkFit first = fit_to_landmarks(body, camera, landmarks, prior, prior.pose, limits);
  std::vector<LandmarkFit> fits = {first};
  const Problem problem{body, camera, landmarks, prior};
  for (const Pose& flip : kinematic_flips(body, first.pose, limits)) {
    fits.push_back({flip, cost_of(problem(flip.vector()))});
  }
  std::stable_sort(fits.begin() + 1, fits.end(),
                   [](const LandmarkFit& a, const LandmarkFit& b) { return a.cost < b.cost; });
  std::vector<LandmarkFit> kept;
  const auto places = [&](const Pose& pose) {
    const JointPositions j = forward_kinematics(body, pose).joints;
    Eigen::Matrix<double, 3, kFollowed> at;
    for (std::size_t i = 0; i < kFollowed; ++i) {
      at.col(static_cast<Eigen::Index>(i)) = j[kFollowedJoints[i]];
    }
    return at;
  };
  for (std::size_t i = 0; i < fits.size() && kept.size() < most; ++i) {
    const LandmarkFit fit =
        i == 0 ? first : fit_to_landmarks(body, camera, landmarks, prior, fits[i].pose, limits);
    const auto here = places(fit.pose);
    const bool is_new = std::none_of(kept.begin(), kept.end(), [&](const LandmarkFit& other) {
      return (places(other.pose) - here).colwise().norm().maxCoeff() < kApart;
    });
    if (is_new) {
      kept.push_back(fit);
    }
  }
  std::stable_sort(kept.begin(), kept.end(),
                   [](const LandmarkFit& a, const LandmarkFit& b) { return a.cost < b.cost; });
  return kept;
}

}  // namespace telemime
