// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/engine.h"

#include <oneapi/tbb/info.h>

#include <algorithm>
#include <array>

#include "telemime/search/budget.h"

namespace telemime {
namespace {

constexpr std::array<std::size_t, 6> kBatches = {1, 10, 100, 1000, 10000, 100000};

// Whether the back end shares a batch between threads; the others use one thread.
bool uses_threads(const std::string& backend) {
  return backend == "simd";
}

double total(const DeviceTimes& times) {
  return times.upload + times.kernel + times.download;
}

// The first `batch` poses from `first` on, around the end when there are too few.
std::span<const Pose> window(const std::vector<Pose>& poses, std::size_t batch, std::size_t& first) {
  if (first + batch > poses.size()) {
    first = 0;
  }
  const auto part = std::span(poses).subspan(first, batch);
  first += batch;
  return part;
}

// Cells of one back end, number of threads and working image, from the smallest batch up.
void measure_batches(const EngineOptions& options, const std::string& name, int threads,
                     const EngineScene& scene, std::vector<Throughput>& cells) {
  const double budget = options.quick ? 0.01 : 0.2;
  const double longest = options.quick ? 0.03 : 1.0;
  const auto backend = make_backend(name, {threads});
  double each = 0.0;  // s for one evaluation, by the batch before
  for (const std::size_t batch : kBatches) {
    Throughput cell = {name, size_name(scene.frame.camera.width, scene.frame.camera.height), threads, batch,
                       std::nullopt};
    if (each * static_cast<double>(batch) <= longest) {
      cell.time = best_batch_time(*backend, scene, batch, Reduction::all, budget, options.seconds);
      each = cell.time->seconds / static_cast<double>(batch);
    }
    cells.push_back(std::move(cell));
  }
}

// One row for each back end, number of threads and image; `field` makes the text of a cell.
Table by_batch(std::span<const Throughput> cells, const std::string& title,
               const std::function<std::string(const Throughput&)>& field) {
  Table table{title, {"back end", "threads", "image"}, {}};
  for (const std::size_t batch : kBatches) {
    table.columns.push_back("batch " + std::to_string(batch));
  }
  for (const Throughput& cell : cells) {
    if (cell.batch == kBatches.front()) {
      table.rows.push_back({cell.backend, std::to_string(cell.threads), cell.size});
    }
    table.rows.back().push_back(cell.time ? field(cell) : "-");
  }
  return table;
}

}  // namespace

std::vector<std::string> engine_backends(const EngineOptions& options) {
  std::vector<std::string> names;
  for (const std::string& name : options.backends) {
    make_backend(name);  // throws for unknown names
    if (std::find(names.begin(), names.end(), name) == names.end()) {
      names.push_back(name);
    }
  }
  if (names.empty()) {
    for (const BackendKind& kind : kBackends) {
      // An alias of another back end would be measured twice.
      if (kind.missing().empty() && make_backend(kind.name)->name() == kind.name) {
        names.emplace_back(kind.name);
      }
    }
  }
  return names;
}

int most_threads(const EngineOptions& options) {
  return options.threads > 0 ? options.threads : tbb::info::default_concurrency();
}

std::vector<std::string> missing_backends() {
  std::vector<std::string> lines;
  for (const BackendKind& kind : kBackends) {
    const std::string reason = kind.missing();
    if (!reason.empty()) {
      lines.push_back(std::string(kind.name) + ": " + reason);
    }
  }
  return lines;
}

std::vector<Camera> engine_cameras() {
  return {Camera{}.scaled_to(160, 120), Camera{}.scaled_to(320, 240), Camera{}.scaled_to(640, 480)};
}

EngineScene engine_scene(const Camera& camera, std::size_t poses, std::uint64_t seed) {
  Random random(seed);
  EngineScene scene = {make_model(Shape{}), {}, typical_poses(poses, random)};
  scene.frame = frame_of_model(scene.model, scene.poses.front(), camera);
  return scene;
}

BatchTime best_batch_time(Backend& backend, const EngineScene& scene, std::size_t batch, Reduction terms,
                          double budget, const std::function<double()>& seconds) {
  std::vector<Score> scores(batch);
  std::size_t first = 0;
  const auto run = [&](int count) {
    const double start = seconds();
    for (int i = 0; i < count; ++i) {
      backend.evaluate(scene.frame, scene.model, window(scene.poses, batch, first), terms, scores);
    }
    return (seconds() - start) / count;
  };
  run(1);
  // Short batches are timed in groups, because the clock is coarse and poses differ in cost.
  const double once = std::max(1e-7, run(1));
  const int together = std::max(1, static_cast<int>(std::min(budget / 10.0, 2e-3) / once));
  BatchTime best = {once, backend.device_times()};
  double spent = once;
  for (int repeat = 0; repeat < 1 || spent < budget; ++repeat) {
    const double time = run(together);
    spent += time * together;
    best.seconds = repeat == 0 && together > 1 ? time : std::min(best.seconds, time);
    const std::optional<DeviceTimes> device = backend.device_times();
    if (device && (!best.device || total(*device) < total(*best.device))) {
      best.device = device;
    }
  }
  return best;
}

std::vector<Throughput> measure_throughput(const EngineOptions& options) {
  const int all = most_threads(options);
  std::vector<Throughput> cells;
  for (const Camera& camera : engine_cameras()) {
    const EngineScene scene = engine_scene(camera, kBatches.back(), options.seed);
    for (const std::string& name : engine_backends(options)) {
      measure_batches(options, name, 1, scene, cells);
      if (all > 1 && uses_threads(name)) {
        measure_batches(options, name, all, scene, cells);
      }
    }
  }
  return cells;
}

Table speed_table(std::span<const Throughput> cells) {
  return by_batch(cells, "Thousand evaluations (F and D_C) a second, by batch size", [](const Throughput& c) {
    return number(1e-3 * static_cast<double>(c.batch) / c.time->seconds);
  });
}

Table time_table(std::span<const Throughput> cells) {
  return by_batch(
      cells, "Microseconds for one evaluation (F and D_C), by batch size",
      [](const Throughput& c) { return number(1e6 * c.time->seconds / static_cast<double>(c.batch)); });
}

Table device_table(std::span<const Throughput> cells) {
  Table table{"One batch on a device, ms",
              {"back end", "image", "batch", "upload ms", "kernel ms", "download ms"},
              {}};
  for (const Throughput& cell : cells) {
    if (cell.time && cell.time->device) {
      const DeviceTimes& times = *cell.time->device;
      table.rows.push_back(row_of(cell.backend, cell.size, cell.batch, 1e3 * times.upload, 1e3 * times.kernel,
                                  1e3 * times.download));
    }
  }
  return table;
}

}  // namespace telemime
