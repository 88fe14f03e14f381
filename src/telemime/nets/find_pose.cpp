// SPDX-License-Identifier: Apache-2.0
#include "telemime/nets/find_pose.h"

#include "telemime/nets/pose_detector.h"

namespace telemime {

PoseNetworks load_pose_networks(const std::filesystem::path& models, PoseModel model, bool with_mask) {
  return {.detector = load_pose_detector(models),
          .landmarker = load_pose_landmarker(models, model, with_mask)};
}

std::optional<PoseLandmarks> find_pose(const cv::Mat& picture, PoseNetworks& networks,
                                       const std::optional<PictureRegion>& previous) {
  if (previous) {
    if (std::optional<PoseLandmarks> found = find_landmarks(picture, *previous, networks.landmarker)) {
      return found;
    }
  }
  for (const Detection& person : detect_poses(picture, networks.detector)) {
    if (std::optional<PoseLandmarks> found =
            find_landmarks(picture, region_of_person(person), networks.landmarker)) {
      return found;
    }
  }
  return std::nullopt;
}

}  // namespace telemime
