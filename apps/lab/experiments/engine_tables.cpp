// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/engine_bench.h"

#include <algorithm>
#include <array>
#include <limits>

#include "lab/experiments/report.h"
#include "lab/experiments/timing.h"
#include "telemime/likelihood/simd/simd_backend.h"

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

constexpr std::array<std::size_t, 4> kHistograms = {100, 300, 500, 700};

}  // namespace

Table stage_table(const EngineOptions& options) {
  std::vector<std::unique_ptr<Backend>> backends;
  Table table{"Stages of simd, one evaluation on one thread", {"stage"}, {}};
  for (const StageName& stage : kStages) {
    backends.push_back(make_simd_backend({1, {}, stage.stage}));
    table.rows.push_back({stage.what});
  }
  table.rows.push_back({"all"});
  for (const Camera& camera : engine_cameras()) {
    const std::vector<double> up_to = each_of(backends, scene_of(camera, options), options);
    const std::string size = size_name(camera);
    table.columns.push_back(size + " us");
    table.columns.push_back(size + " %");
    for (std::size_t i = 0; i < up_to.size(); ++i) {
      const double alone = up_to[i] - (i > 0 ? up_to[i - 1] : 0.0);
      table.rows[i].push_back(number(alone));
      table.rows[i].push_back(number(100.0 * alone / up_to.back()));
    }
    table.rows.back().push_back(number(up_to.back()));
    table.rows.back().push_back("100");
  }
  return table;
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
    table.columns.push_back(size_name(camera) + " us");
    for (std::size_t i = 0; i < each.size(); ++i) {
      table.rows[i].push_back(number(each[i]));
    }
  }
  return table;
}

Table opencv_table(const EngineOptions& options) {
  std::vector<std::unique_ptr<Backend>> backends;
  backends.push_back(make_literal_opencv());
  backends.push_back(make_opencv_baseline());
  backends.push_back(make_simd_backend());
  Table table{
      "OpenCV beside simd, one evaluation on one thread",
      {"image", "step by step us", "for speed us", "simd us", "step by step : simd", "for speed : simd"},
      {}};
  for (const Camera& camera : engine_cameras()) {
    const std::vector<double> each = each_of(backends, scene_of(camera, options), options);
    table.rows.push_back({size_name(camera), number(each[0]), number(each[1]), number(each[2]),
                          number(each[0] / each[2]), number(each[1] / each[2])});
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
  for (std::size_t h = 0; h < kHistograms.size(); ++h) {
    table.rows.push_back({std::to_string(kHistograms[h])});
    for (const Timed& column : timed) {
      const BatchTime time = best_batch_time(*column.backend, scene, kHistograms[h], Reduction::overlap,
                                             options.quick ? 0.01 : 0.2, options.seconds);
      table.rows.back().push_back(number(1e3 * time.seconds));
    }
  }
  return beside(table, published_values("T4-1"));
}

}  // namespace telemime
