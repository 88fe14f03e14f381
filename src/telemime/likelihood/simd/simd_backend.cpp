// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "telemime/core/errors.h"
#include "telemime/cues/all.h"
#include "telemime/likelihood/backend.h"
#include "telemime/likelihood/simd/kernel.h"

namespace telemime {
namespace {

class SimdBackend final : public Backend {
 public:
  explicit SimdBackend(simd::InstructionSet set) : set_(set) {}
  std::string_view name() const override { return "simd"; }

  void evaluate(const PreparedFrame& frame, const Model& model, std::span<const Pose> poses, Reduction terms,
                std::span<Score> scores) override {
    if (poses.size() != scores.size()) {
      throw Error(ErrorKind::usage, "evaluate: as many scores as poses are needed");
    }
    const simd::Pinhole camera = {static_cast<float>(frame.camera.fx), static_cast<float>(frame.camera.fy),
                                  static_cast<float>(frame.camera.cx), static_cast<float>(frame.camera.cy)};
    const simd::Batch batch = {models_.of(model.body, model.mesh), frame.tiles, camera, terms};
    counts_.resize(poses.size());
    std::fill(counts_.begin(), counts_.end(), Reductions{});
    set_.kernel(batch, poses, counts_, *workspace_);
    for (std::size_t i = 0; i < poses.size(); ++i) {
      Score score;
      score.reductions = counts_[i];
      if (wants(terms, Reduction::overlap)) {
        score.reductions.observed = frame.observed;
        score.region = non_overlapping_ratio(score.reductions);
      }
      if (wants(terms, Reduction::contour)) {
        score.contour = mean_edge_distance(score.reductions, frame.distance_cap);
      }
      scores[i] = score;
    }
  }

 private:
  simd::InstructionSet set_;
  PackedModelCache models_;
  std::unique_ptr<simd::Workspace> workspace_ = std::make_unique<simd::Workspace>();
  std::vector<Reductions> counts_;
};

}  // namespace

std::unique_ptr<Backend> make_simd_backend() {
  return std::make_unique<SimdBackend>(simd::instruction_sets().front());
}

}  // namespace telemime
