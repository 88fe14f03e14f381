// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <limits>

#include "lab/experiments/engine.h"
#include "lab/experiments/experiments.h"
#include "telemime/likelihood/simd/simd_backend.h"
#include "telemime/render/renderer.h"

namespace telemime {
namespace {

constexpr std::size_t kBatch = 1000;
constexpr double kMicroseconds = 1e6;

struct StageName {
  SimdStage stage;
  const char* what;
};
constexpr std::array<StageName, 7> kStages = {{{SimdStage::place, "kinematics"},
                                               {SimdStage::project, "projecting vertices"},
                                               {SimdStage::set_up, "facing, edges and planes"},
                                               {SimdStage::draw, "drawing"},
                                               {SimdStage::sample, "points of the contour"},
                                               {SimdStage::look_up, "distances under them"},
                                               {SimdStage::count, "counting, clearing"}}};

constexpr std::array<const char*, 4> kScalarStages = {"kinematics", "drawing", "points of the contour",
                                                      "counting, distances"};

// What `scalar` does up to a stage of kScalarStages, without the last one.
class ScalarUpTo final : public Backend {
 public:
  explicit ScalarUpTo(std::size_t stage) : stage_(stage) {}
  std::string_view name() const override { return "part of scalar"; }
  void count(const PreparedFrame& frame, const Model& model, std::span<const Pose> poses,
             std::span<const Kinematics>, Reduction, std::span<Reductions>) override {
    for (const Pose& pose : poses) {
      const Kinematics kinematics = forward_kinematics(model.body, pose);
      if (stage_ >= 1) {
        render(model.mesh, kinematics, frame.camera, rendering_);
      }
      if (stage_ >= 2) {
        occluding_contour(model.mesh, rendering_, contour_);
      }
    }
  }

 private:
  std::size_t stage_;
  Rendering rendering_;
  std::vector<Eigen::Vector2f> contour_;
};

// Microseconds for one evaluation by each back end. The back ends alternate several times, so that other load
// on the machine affects all of them.
std::vector<double> each_of(const std::vector<std::unique_ptr<Backend>>& backends, const EngineScene& scene,
                            const EngineOptions& options) {
  std::vector<double> best(backends.size(), std::numeric_limits<double>::infinity());
  const int turns = options.quick ? 1 : 5;
  for (int turn = 0; turn < turns; ++turn) {
    for (std::size_t i = 0; i < backends.size(); ++i) {
      const BatchTime time = best_batch_time(*backends[i], scene, scene.poses.size(), Reduction::all,
                                             options.quick ? 0.0 : 0.04, options.seconds);
      best[i] = std::min(best[i], kMicroseconds * time.seconds / static_cast<double>(scene.poses.size()));
    }
  }
  return best;
}

EngineScene scene_of(const Camera& camera, const EngineOptions& options) {
  return engine_scene(camera, options.quick ? kBatch / 10 : kBatch, options.seed);
}

// Appends the columns of times to the stages' names; each back end ends after its stage.
Table with_stages(Table table, const std::vector<std::unique_ptr<Backend>>& backends,
                  const EngineOptions& options) {
  table.rows.push_back({"all"});
  for (const Camera& camera : engine_cameras()) {
    const std::vector<double> up_to = each_of(backends, scene_of(camera, options), options);
    table.columns.push_back(size_name(camera.width, camera.height) + " us");
    table.columns.push_back(size_name(camera.width, camera.height) + " %");
    for (std::size_t i = 0; i <= up_to.size(); ++i) {
      const double alone = i == up_to.size() ? up_to.back() : up_to[i] - (i > 0 ? up_to[i - 1] : 0.0);
      add_fields(table.rows[i], alone, 100.0 * alone / up_to.back());
    }
  }
  return table;
}

constexpr std::array<std::size_t, 4> kHistograms = {100, 300, 500, 700};

}  // namespace

Table simd_stage_table(const EngineOptions& options) {
  Table table{"Stages of simd, one evaluation on one thread", {"stage"}, {}};
  std::vector<std::unique_ptr<Backend>> backends;
  for (const StageName& stage : kStages) {
    backends.push_back(make_simd_backend({1, {}, stage.stage}));
    table.rows.push_back({stage.what});
  }
  return with_stages(std::move(table), backends, options);
}

Table scalar_stage_table(const EngineOptions& options) {
  Table table{"Stages of scalar, one evaluation on one thread", {"stage"}, {}};
  std::vector<std::unique_ptr<Backend>> backends;
  for (std::size_t stage = 0; stage < kScalarStages.size(); ++stage) {
    backends.push_back(stage + 1 < kScalarStages.size() ? std::make_unique<ScalarUpTo>(stage)
                                                        : make_scalar_backend());
    table.rows.push_back({kScalarStages[stage]});
  }
  return with_stages(std::move(table), backends, options);
}

Table instruction_set_table(const EngineOptions& options) {
  const std::vector<std::string> sets = simd_instruction_sets();
  std::vector<std::unique_ptr<Backend>> backends;
  Table table{"simd by instruction set, one evaluation on one thread, us", {"instructions"}, {}};
  for (const std::string& set : sets) {
    backends.push_back(make_simd_backend({1, set, SimdStage::count}));
    table.rows.push_back({set});
  }
  for (const Camera& camera : engine_cameras()) {
    const std::vector<double> each = each_of(backends, scene_of(camera, options), options);
    table.columns.push_back(size_name(camera.width, camera.height) + " us");
    for (std::size_t i = 0; i < each.size(); ++i) {
      table.rows[i].push_back(number(each[i]));
    }
  }
  return table;
}

Table opencv_table(const EngineOptions& options) {
  std::vector<std::unique_ptr<Backend>> backends;
  backends.push_back(make_literal_opencv());
  backends.push_back(make_fast_opencv());
  backends.push_back(make_simd_backend());
  Table table{
      "OpenCV beside simd, one evaluation on one thread",
      {"image", "step by step us", "for speed us", "simd us", "step by step : simd", "for speed : simd"},
      {}};
  for (const Camera& camera : engine_cameras()) {
    const std::vector<double> each = each_of(backends, scene_of(camera, options), options);
    table.rows.push_back(row_of(size_name(camera.width, camera.height), each[0], each[1], each[2],
                                each[0] / each[2], each[1] / each[2]));
  }
  return table;
}

Table overlap_time_table(const EngineOptions& options) {
  const int all = most_threads(options);
  struct Timed {
    std::string title;
    std::unique_ptr<Backend> backend;
  };
  std::vector<Timed> timed;
  for (const std::string& name : engine_backends(options)) {
    timed.push_back({name, make_backend(name)});
    if (name == "simd" && all > 1) {
      timed.push_back({"simd, " + std::to_string(all) + " threads", make_backend(name, {all})});
    }
  }
  Table table{"Table 4-1: overlap histograms at 160x120, ms", {"histograms"}, {}};
  for (const Timed& column : timed) {
    table.columns.push_back(column.title);
  }
  const EngineScene scene = engine_scene(engine_cameras().front(), 10 * kHistograms.back(), options.seed);
  for (const std::size_t histograms : kHistograms) {
    table.rows.push_back({std::to_string(histograms)});
    for (const Timed& column : timed) {
      const BatchTime time = best_batch_time(*column.backend, scene, histograms, Reduction::overlap,
                                             options.quick ? 0.01 : 0.2, options.seconds);
      table.rows.back().push_back(number(1e3 * time.seconds));
    }
  }
  return beside(table, published_values("T4-1"));
}

}  // namespace telemime
