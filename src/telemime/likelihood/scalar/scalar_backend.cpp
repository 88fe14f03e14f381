// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "telemime/core/errors.h"
#include "telemime/cues/all.h"
#include "telemime/likelihood/backend.h"
#include "telemime/render/renderer.h"

namespace telemime {
namespace {

void count_overlap(const PreparedFrame& frame, const Rendering& rendering, Reductions& r) {
  // Bins by (model class, label): label 0 background, 1-3 classes; "ignore" falls into a bin that is not
  // read.
  std::array<std::array<std::int32_t, 8>, 4> bins{};
  for (int y = rendering.top; y < rendering.bottom; ++y) {
    const std::uint8_t* label = frame.labels.ptr<std::uint8_t>(y);
    const std::uint8_t* surface =
        rendering.surface.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(rendering.width);
    for (int x = rendering.left; x < rendering.right; ++x) {
      ++bins[surface[x] & 3U][label[x] & 7U];
    }
  }
  r.observed = frame.observed;
  for (std::size_t c = 0; c < kSurfaceClassCount; ++c) {
    const auto& row = bins[c + 1];
    r.model[c] = row[0] + row[1] + row[2] + row[3];
    r.both[c] = row[c + 1];
  }
}

void sum_contour(const PreparedFrame& frame, const std::vector<Eigen::Vector2f>& contour, Reductions& r) {
  double sum = 0.0;
  for (const Eigen::Vector2f& p : contour) {
    sum +=
        frame.distance.at<float>(static_cast<int>(std::lround(p.y())), static_cast<int>(std::lround(p.x())));
  }
  r.contour_sum = sum;
  r.contour_points = static_cast<std::int32_t>(contour.size());
}

class ScalarBackend final : public Backend {
 public:
  std::string_view name() const override { return "scalar"; }

  void evaluate(const PreparedFrame& frame, const Model& model, std::span<const Pose> poses, Reduction terms,
                std::span<Score> scores) override {
    if (poses.size() != scores.size()) {
      throw Error(ErrorKind::usage, "evaluate: as many scores as poses are needed");
    }
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const Kinematics kinematics = forward_kinematics(model.body, poses[i]);
      render(model.mesh, kinematics, frame.camera, rendering_);
      Score score;
      if (wants(terms, Reduction::overlap)) {
        count_overlap(frame, rendering_, score.reductions);
        score.region = non_overlapping_ratio(score.reductions);
      }
      if (wants(terms, Reduction::contour)) {
        occluding_contour(model.mesh, rendering_, contour_);
        sum_contour(frame, contour_, score.reductions);
        score.contour = mean_edge_distance(score.reductions, frame.distance_cap);
      }
      scores[i] = score;
    }
  }

 private:
  Rendering rendering_;
  std::vector<Eigen::Vector2f> contour_;
};

}  // namespace

std::unique_ptr<Backend> make_scalar_backend() {
  return std::make_unique<ScalarBackend>();
}

}  // namespace telemime
