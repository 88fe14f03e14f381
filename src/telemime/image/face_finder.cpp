// SPDX-License-Identifier: Apache-2.0
#include "telemime/image/face_finder.h"

#include <utility>

#include "telemime/image/person_finder.h"

namespace telemime {

FaceFinder::FaceFinder(const std::filesystem::path& models)
    : networks_(std::make_shared<FaceNetworks>(load_face_networks(models))) {}

void FaceFinder::prepare(const cv::Mat& picture, double time) {
  // While find() is not called because nobody is there, nothing is looked at again.
  if (networks_ && region_ && !prepared_) {
    prepared_ = {.time = time, .face = face_in(picture, *region_, *networks_)};
  }
}

std::optional<FaceLandmarks> FaceFinder::find(const cv::Mat& picture, const PoseLandmarks& person,
                                              cv::Size working, double time) {
  const std::optional<Seen> prepared = std::exchange(prepared_, std::nullopt);
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
  // Where it was, then wherever the detector sees one.
  std::optional<FaceLandmarks> face;
  if (region_) {
    const bool is_prepared = prepared && prepared->time == time;
    face = is_prepared ? prepared->face : face_in(picture, *region_, *networks_);
  }
  if (!face) {
    face = find_face(picture, head, *networks_);
  }
  if (face && !is_near(face->next_region)) {
    face.reset();
  }
  region_ = face ? std::optional(face->next_region) : std::nullopt;
  return face;
}

}  // namespace telemime
