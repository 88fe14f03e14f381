// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "telemime/body/motion_frame.h"
#include "telemime/evaluation/truth.h"

namespace telemime {

/// The joints that the headline is averaged over (thesis 3.6.2.1): elbows and wrists.
inline constexpr std::array<Joint, 4> kScoredJoints = {Joint::l_elbow, Joint::r_elbow, Joint::l_wrist,
                                                       Joint::r_wrist};

/// How far one joint is from the truth. Estimate minus truth; m and pixels of the truth's image.
struct JointError {
  Eigen::Vector3d camera;                  ///< as both stand in the camera frame
  std::optional<Eigen::Vector3d> aligned;  ///< mid-shoulders made to coincide; needs both true shoulders
  std::optional<Eigen::Vector3d> fitted;   ///< after the best similarity (Umeyama 1991) of the frame's joints
  std::optional<double> pixels;            ///< distance in the image (thesis 3.18); needs z > 0
  std::optional<double> pixels_at_depth;   ///< the same in m at the depth of the true shoulders (or joint)
};

/// By Joint; nothing for a joint that the truth does not have.
using FrameErrors = std::array<std::optional<JointError>, kJointCount>;

/// Compares one frame with its truth. `scale` multiplies the estimate before it is compared (1 when the
/// truth's scale is known). `input` is the camera whose pixels frame.pixels are; the truth's image may have
/// another size.
FrameErrors measure_frame(const MotionFrame& frame, const Camera& input, const TruthJoints& truth,
                          const Camera& truth_camera, double scale);

/// Joints with the middle of the shoulders as origin, m; nothing when a shoulder is unknown.
std::optional<TruthJoints> shoulder_centred(const TruthJoints& joints);

/// The joints of a frame in the form of the truth.
TruthJoints as_truth(const JointPositions& joints);

/// Is the arm of each side mistaken for the other's in the image? True when exchanging the elbows and wrists
/// of the estimate brings them nearer to the truth, in the mean over the four joints, by more than a quarter
/// of the true shoulder width. Needs all four joints and both shoulders of the truth; false without.
bool arms_are_swapped(const MotionFrame& frame, const Camera& input, const TruthJoints& truth,
                      const Camera& truth_camera);

}  // namespace telemime
