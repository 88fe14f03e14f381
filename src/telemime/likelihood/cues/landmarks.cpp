// SPDX-License-Identifier: Apache-2.0
#include "telemime/likelihood/cues/landmarks.h"

#include <cmath>

namespace telemime {

double landmark_cost(const CueInput& input) {
  const auto& landmarks = input.frame.landmarks;
  if (!landmarks) {
    return 0.0;
  }
  double sum = 0.0;
  for (std::size_t i = 0; i < kLandmarkCount; ++i) {
    const double squared =
        landmark_error(landmarks->points[i], input.frame.camera, (*input.landmarks)[i]).squaredNorm();
    sum += robust_square(squared, kMostLandmark);
  }
  return std::sqrt(sum / (2.0 * kLandmarkCount));
}

double bone_cost(const CueInput& input) {
  const auto& landmarks = input.frame.landmarks;
  if (!landmarks) {
    return 0.0;
  }
  const auto bones = landmark_bones(*input.landmarks);
  double sum = 0.0;
  for (std::size_t i = 0; i < kLandmarkBoneCount; ++i) {
    const double error = bone_error(landmarks->bones[i], landmarks->ray, bones[i]);
    sum += robust_square(error * error, kMostBone);
  }
  return std::sqrt(sum / kLandmarkBoneCount);
}

}  // namespace telemime
