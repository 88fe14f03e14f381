// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string_view>

#include "telemime/body/body.h"
#include "telemime/body/mesh.h"
#include "telemime/core/camera.h"
#include "telemime/image/frame_features.h"
#include "telemime/likelihood/cues/reductions.h"
#include "telemime/likelihood/device_times.h"
#include "telemime/likelihood/tiled_planes.h"

namespace telemime {

/// The person as the likelihood sees them: skeleton and surface.
struct Model {
  Body body;
  BodyMesh mesh;
};

Model make_model(const Shape& shape);

/// One frame made ready for evaluation by prepare(); its parts belong together and are not to be changed.
/// Holds no pose; may be used by many threads.
struct PreparedFrame {
  Camera camera;     ///< of the working image
  cv::Mat labels;    ///< (h x w) CV_8UC1, Label
  cv::Mat distance;  ///< (h x w) CV_32FC1, px
  std::array<std::int32_t, kSurfaceClassCount> observed{};
  double distance_cap = 0.0;  ///< px, the largest value of the distance map
  TiledPlanes tiles;          ///< labels and distance once more, for back ends that read them by tiles
};

/// F and D_C of one pose (algorithms: 4.1, 4.2).
struct Score {
  double region = 1.0;   ///< F, in [0, 1]
  double contour = 0.0;  ///< D_C, px of the working image
  Reductions reductions;
};

/// Evaluates batches of poses. One virtual call a batch, no hidden current frame. Implementations must agree
/// with `scalar`, which is the definition.
class Backend {
 public:
  Backend() = default;
  Backend(const Backend&) = delete;
  Backend& operator=(const Backend&) = delete;
  virtual ~Backend() = default;
  virtual std::string_view name() const = 0;
  /// scores[i] for poses[i]; terms that are not asked for keep their defaults. Sizes must match.
  virtual void evaluate(const PreparedFrame& frame, const Model& model, std::span<const Pose> poses,
                        Reduction terms, std::span<Score> scores) = 0;
  /// Of the last batch; nothing from back ends that run on the processor.
  virtual std::optional<DeviceTimes> device_times() const { return std::nullopt; }
};

/// `camera` is the one of the working image of the features. Throws Error(usage) when they do not
/// match.
PreparedFrame prepare(const FrameFeatures& features, const Camera& camera);

/// The same into a frame whose memory is used again.
void prepare(const FrameFeatures& features, const Camera& camera, PreparedFrame& frame);

/// The definition: exact z-buffered meshes, one pose after the other.
std::unique_ptr<Backend> make_scalar_backend();

}  // namespace telemime
