// SPDX-License-Identifier: Apache-2.0
#include "telemime/likelihood/prepared_frame.h"

#include <algorithm>

#include "telemime/core/errors.h"

namespace telemime {

Model make_model(const Shape& shape) {
  const Body body = make_body(shape);
  return {body, make_mesh(body)};
}

PreparedFrame prepare(const FrameFeatures& features, const Camera& camera) {
  PreparedFrame frame;
  prepare(features, camera, frame);
  return frame;
}

void prepare(const FrameFeatures& features, const Camera& camera, PreparedFrame& frame) {
  const cv::Size size(camera.width, camera.height);
  if (features.labels.size() != size || features.distance.size() != size ||
      features.labels.type() != CV_8UC1 || features.distance.type() != CV_32FC1) {
    throw Error(ErrorKind::usage, "the features have another size or type than the camera's image");
  }
  frame.camera = camera;
  frame.observed = {};
  frame.distance_cap = 0.0;
  frame.labels = features.labels.isContinuous() ? features.labels : features.labels.clone();
  frame.distance = features.distance.isContinuous() ? features.distance : features.distance.clone();
  const std::uint8_t* label = frame.labels.ptr<std::uint8_t>();
  const float* distance = frame.distance.ptr<float>();
  for (std::size_t i = 0; i < frame.labels.total(); ++i) {
    if (label[i] >= 1 && label[i] <= kSurfaceClassCount) {
      ++frame.observed[label[i] - 1U];
    }
    frame.distance_cap = std::max(frame.distance_cap, static_cast<double>(distance[i]));
  }
  frame.has_colours = features.has_colour_model;
  frame.label_reliability = 1.0;
  frame.landmarks = features.landmarks ? std::optional(observe(*features.landmarks, camera)) : std::nullopt;
  tile(frame.labels, frame.distance, frame.tiles);
}

}  // namespace telemime
