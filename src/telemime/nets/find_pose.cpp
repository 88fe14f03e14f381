// SPDX-License-Identifier: Apache-2.0
#include "telemime/nets/find_pose.h"

#include <utility>

#include "telemime/nets/pose_detector.h"

namespace telemime {

PoseNetworks load_pose_networks(const std::filesystem::path& models, PoseModel model) {
  return {.detector = load_pose_detector(models),
          .landmarker = load_pose_landmarker(models, model),
          .mask = load_mask_networks(models, model)};
}

std::optional<PoseLandmarks> find_pose(const cv::Mat& picture, PoseNetworks& networks,
                                       const std::optional<PictureRegion>& previous) {
  const auto with_mask = [&](SeenPerson seen) {
    seen.landmarks.mask = person_mask(seen.mask, picture.size(), networks.mask);
    return std::move(seen.landmarks);
  };
  if (previous) {
    if (std::optional<SeenPerson> found = find_landmarks(picture, *previous, networks.landmarker)) {
      return with_mask(*std::move(found));
    }
  }
  for (const Detection& person : detect_poses(picture, networks.detector)) {
    if (std::optional<SeenPerson> found =
            find_landmarks(picture, region_of_person(person), networks.landmarker)) {
      return with_mask(*std::move(found));
    }
  }
  return std::nullopt;
}

}  // namespace telemime
