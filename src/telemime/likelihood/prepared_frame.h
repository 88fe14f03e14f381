// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <optional>

#include "telemime/body/body.h"
#include "telemime/body/mesh.h"
#include "telemime/core/camera.h"
#include "telemime/image/frame_features.h"
#include "telemime/likelihood/body_landmarks.h"
#include "telemime/likelihood/tiled_planes.h"

namespace telemime {

/// The person as the likelihood sees them: skeleton and surface.
struct Model {
  Body body;
  BodyMesh mesh;
};

Model make_model(const Shape& shape);

/// One frame made ready for evaluation by prepare(). Its members belong together and must not be changed.
/// Holds no pose; many threads may read it.
struct PreparedFrame {
  Camera camera;                                            ///< of the working image
  cv::Mat labels;                                           ///< (h x w) CV_8UC1, Label
  cv::Mat distance;                                         ///< (h x w) CV_32FC1, px
  std::array<std::int32_t, kSurfaceClassCount> observed{};  ///< pixels of each class
  double distance_cap = 0.0;                                ///< px, the largest value of the distance map
  bool has_colours = true;                 ///< the colours of the person are known: labels tell classes apart
  double label_reliability = 1.0;          ///< how far the labels can be trusted (label_reliability())
  std::optional<BodyLandmarks> landmarks;  ///< empty: no network has looked, or it sees nobody
  TiledPlanes tiles;                       ///< labels and distance in tiles, for back ends that read them so
};

/// Prepares the features of a frame. `camera` is that of their working image. Throws Error(usage) when
/// their sizes differ.
PreparedFrame prepare(const FrameFeatures& features, const Camera& camera);

/// The same into `frame`, whose memory is reused.
void prepare(const FrameFeatures& features, const Camera& camera, PreparedFrame& frame);

}  // namespace telemime
