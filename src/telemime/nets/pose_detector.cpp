// SPDX-License-Identifier: Apache-2.0
#include "telemime/nets/pose_detector.h"

#include <string>

#include "telemime/nets/models/table.h"

namespace telemime {

Network load_pose_detector(const std::filesystem::path& models) {
  const std::vector<std::string> outputs = {"Identity", "Identity_1"};  // boxes, scores
  return load_network(models, "pose_detection", {.inputs = {}, .outputs = outputs});
}

std::vector<Detection> detect_poses(const cv::Mat& picture, Network& detector) {
  const SingleShotFormat format{.input = 224, .grids = {{28, 2}, {14, 2}, {7, 6}}, .keypoints = 4};
  return detect(picture, square_around(picture), detector, format);
}

PictureRegion region_of_person(const Detection& person) {
  return region_of_axis(person.keypoints[0], person.keypoints[1]);
}

}  // namespace telemime
