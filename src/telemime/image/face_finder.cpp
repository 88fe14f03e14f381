// SPDX-License-Identifier: Apache-2.0
#include "telemime/image/face_finder.h"


#include "telemime/image/person_finder.h"

namespace telemime {

FaceFinder::FaceFinder(const std::filesystem::path& models)
    : networks_(std::make_shared<FaceNetworks>(load_face_networks(models))) {}

std::optional<FaceLandmarks> FaceFinder::find(const cv::Mat& picture, const PoseLandmarks& person,
                                              cv::Size working) {
  if (!networks_) {
    return std::nullopt;
  }
  const PictureRegion head = head_region(scaled_to(person, working, picture.size()));
  // Another person's face, or what was taken for one, is not followed away from the head.
  constexpr double kAside = 0.3;  // of the head's region, which is some 0.6 m wide
  const auto is_near = [&](const PictureRegion& face) {
    return (face.centre - head.centre).norm() < kAside * head.width;
  };
  if (region_ && !is_near(*region_)) {
    region_.reset();
  }
  std::optional<FaceLandmarks> face = find_face(picture, head, *networks_, region_);
  if (face && !is_near(face->next_region)) {
    face.reset();
  }
  if (face) {
    look_again(picture, *networks_, *face);
  }
  region_ = face ? std::optional(face->next_region) : std::nullopt;
  return face;
}

}  // namespace telemime
