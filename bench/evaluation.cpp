// SPDX-License-Identifier: Apache-2.0
// Time of one evaluation of a pose: kinematics, rendering, contour, F, D_C and both, by working size.
#include <benchmark/benchmark.h>

#include <array>
#include <vector>

#include "telemime/render/renderer.h"
#include "telemime/search/budget.h"

namespace telemime {
namespace {

struct Bench {
  Model model = make_model(Shape{});
  Random random{1};
  std::vector<Pose> poses = typical_poses(64, random);
  std::vector<Score> scores = std::vector<Score>(poses.size());
  std::unique_ptr<Backend> backend = make_scalar_backend();
};

Camera camera_of(const benchmark::State& state) {
  return Camera{}.scaled_to(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)));
}

void sizes(benchmark::internal::Benchmark* b) {
  b->ArgNames({"w", "h"})->Args({160, 120})->Args({320, 240})->Args({640, 480});
  b->Unit(benchmark::kMicrosecond);
}

void kinematics(benchmark::State& state) {
  const Bench b;
  std::size_t i = 0;
  for ([[maybe_unused]] const auto step : state) {
    benchmark::DoNotOptimize(forward_kinematics(b.model.body, b.poses[++i % b.poses.size()]));
  }
}
BENCHMARK(kinematics)->Unit(benchmark::kMicrosecond);

void render_planes(benchmark::State& state) {
  const Bench b;
  const Camera camera = camera_of(state);
  std::vector<Kinematics> kinematics;
  for (const Pose& pose : b.poses) {
    kinematics.push_back(forward_kinematics(b.model.body, pose));
  }
  Rendering rendering;
  std::size_t i = 0;
  for ([[maybe_unused]] const auto step : state) {
    render(b.model.mesh, kinematics[++i % kinematics.size()], camera, rendering);
    benchmark::ClobberMemory();
  }
}
BENCHMARK(render_planes)->Apply(sizes);

void contour_points(benchmark::State& state) {
  const Bench b;
  Rendering rendering;
  render(b.model.mesh, forward_kinematics(b.model.body, b.poses[0]), camera_of(state), rendering);
  std::vector<Eigen::Vector2f> contour;
  for ([[maybe_unused]] const auto step : state) {
    occluding_contour(b.model.mesh, rendering, contour);
    benchmark::ClobberMemory();
  }
}
BENCHMARK(contour_points)->Apply(sizes);

template <Reduction terms>
void evaluation(benchmark::State& state) {
  Bench b;
  const PreparedFrame frame = frame_of_model(b.model, b.poses[0], camera_of(state));
  for ([[maybe_unused]] const auto step : state) {
    b.backend->evaluate(frame, b.model, b.poses, terms, b.scores);
  }
  // Poses per second.
  state.counters["evaluations/s"] =
      benchmark::Counter(static_cast<double>(state.iterations()) * static_cast<double>(b.poses.size()),
                         benchmark::Counter::kIsRate);
}
BENCHMARK(evaluation<Reduction::overlap>)->Name("batch of 64 F")->Apply(sizes);
BENCHMARK(evaluation<Reduction::contour>)->Name("batch of 64 D_C")->Apply(sizes);
BENCHMARK(evaluation<Reduction::all>)->Name("batch of 64 F and D_C")->Apply(sizes);

}  // namespace
}  // namespace telemime
