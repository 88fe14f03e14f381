// SPDX-License-Identifier: Apache-2.0
#include "telemime/evaluation/frame_errors.h"

#include <Eigen/Geometry>
#include <vector>

namespace telemime {
namespace {

constexpr double kSwapMargin = 0.25;  // of the shoulder width

std::size_t index(Joint joint) {
  return static_cast<std::size_t>(joint);
}

std::optional<Eigen::Vector3d> mid_shoulder(const TruthJoints& joints) {
  const auto& left = joints[index(Joint::l_shoulder)];
  const auto& right = joints[index(Joint::r_shoulder)];
  if (!left || !right) {
    return std::nullopt;
  }
  return Eigen::Vector3d(0.5 * (*left + *right));
}

/// Pixel centres at integers: an image of another size shares its borders, not its corner centres.
Eigen::Vector2d in_truth_image(const Eigen::Vector2d& pixel, const Camera& input, const Camera& truth) {
  const Eigen::Array2d ratio(static_cast<double>(truth.width) / input.width,
                             static_cast<double>(truth.height) / input.height);
  return (pixel.array() + 0.5) * ratio - 0.5;
}

/// Similarity that brings the estimate's joints onto the truth's, or nothing with too few or coinciding
/// joints.
std::optional<Eigen::Matrix4d> best_similarity(const JointPositions& estimate, const TruthJoints& truth) {
  std::vector<std::size_t> known;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    if (truth[j]) {
      known.push_back(j);
    }
  }
  if (known.size() < 4) {
    return std::nullopt;
  }
  Eigen::Matrix3Xd from(3, known.size());
  Eigen::Matrix3Xd to(3, known.size());
  for (std::size_t k = 0; k < known.size(); ++k) {
    from.col(static_cast<Eigen::Index>(k)) = estimate.at[known[k]];
    to.col(static_cast<Eigen::Index>(k)) = *truth[known[k]];
  }
  const Eigen::Matrix4d fit = Eigen::umeyama(from, to, /*with_scaling=*/true);
  if (!fit.allFinite()) {
    return std::nullopt;
  }
  return fit;
}

}  // namespace

TruthJoints as_truth(const JointPositions& joints) {
  TruthJoints result;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    result[j] = joints.at[j];
  }
  return result;
}

std::optional<TruthJoints> shoulder_centred(const TruthJoints& joints) {
  const auto origin = mid_shoulder(joints);
  if (!origin) {
    return std::nullopt;
  }
  TruthJoints result = joints;
  for (auto& joint : result) {
    if (joint) {
      *joint -= *origin;
    }
  }
  return result;
}

FrameErrors measure_frame(const MotionFrame& frame, const Camera& input, const TruthJoints& truth,
                          const Camera& truth_camera, double scale) {
  JointPositions estimate = frame.joints;
  for (auto& joint : estimate.at) {
    joint *= scale;
  }
  const auto fit = best_similarity(estimate, truth);
  const auto true_middle = mid_shoulder(truth);
  const Eigen::Vector3d middle = *mid_shoulder(as_truth(estimate));
  FrameErrors errors;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    if (!truth[j]) {
      continue;
    }
    const Eigen::Vector3d& place = estimate.at[j];
    const Eigen::Vector3d& goal = *truth[j];
    JointError error;
    error.camera = place - goal;
    if (true_middle) {
      error.aligned = (place - middle) - (goal - *true_middle);
    }
    if (fit) {
      error.fitted = fit->topLeftCorner<3, 3>() * place + fit->topRightCorner<3, 1>() - goal;
    }
    if (goal.z() > 0.0) {
      const Eigen::Vector2d seen = in_truth_image(frame.pixels[j], input, truth_camera);
      error.pixels = (seen - truth_camera.project(goal)).norm();
      const double depth = true_middle ? true_middle->z() : goal.z();
      error.pixels_at_depth = *error.pixels * depth / truth_camera.fx;
    }
    errors[j] = error;
  }
  return errors;
}

bool arms_are_swapped(const MotionFrame& frame, const Camera& input, const TruthJoints& truth,
                      const Camera& truth_camera) {
  const auto middle = mid_shoulder(truth);
  if (!middle || middle->z() <= 0.0) {
    return false;
  }
  const double width = (*truth[index(Joint::l_shoulder)] - *truth[index(Joint::r_shoulder)]).norm() *
                       truth_camera.fx / middle->z();
  double as_is = 0.0;
  double exchanged = 0.0;
  for (const auto& [joint, other] :
       {std::pair(Joint::l_elbow, Joint::r_elbow), std::pair(Joint::r_elbow, Joint::l_elbow),
        std::pair(Joint::l_wrist, Joint::r_wrist), std::pair(Joint::r_wrist, Joint::l_wrist)}) {
    const auto& goal = truth[index(joint)];
    if (!goal || goal->z() <= 0.0) {
      return false;
    }
    const Eigen::Vector2d target = truth_camera.project(*goal);
    as_is += (in_truth_image(frame.pixels[index(joint)], input, truth_camera) - target).norm();
    exchanged += (in_truth_image(frame.pixels[index(other)], input, truth_camera) - target).norm();
  }
  return (as_is - exchanged) / 4.0 > kSwapMargin * width;
}

}  // namespace telemime
