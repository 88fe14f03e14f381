// SPDX-License-Identifier: Apache-2.0
// Time of one frame: features by working size, and everything from image to pose. The clip is synthetic, so
// that no data are needed.
#include <benchmark/benchmark.h>

#include <opencv2/core.hpp>

#include "synthetic_clip.h"
#include "telemime/tracker/track_frame.h"

namespace telemime {
namespace {

const SyntheticClip& clip() {
  static const SyntheticClip made = make_synthetic_clip();
  return made;
}
ImageConfig image_config(const benchmark::State& state) {
  ImageConfig config;
  config.width = static_cast<int>(state.range(0));
  config.height = static_cast<int>(state.range(1));
  return config;
}

void sizes(benchmark::internal::Benchmark* b) {
  b->ArgNames({"w", "h"})->Args({160, 120})->Args({320, 240})->Args({640, 480});
  b->Unit(benchmark::kMillisecond);
}

void features(benchmark::State& state) {
  cv::setNumThreads(1);
  FeatureExtractor extractor(image_config(state));
  extractor.learn_background(clip().background);
  if (!extractor.learn_person(clip().frames[0]).accepted) {
    state.SkipWithError("no face was found in the first picture");
    return;
  }
  std::size_t i = 0;
  for ([[maybe_unused]] const auto step : state) {
    benchmark::DoNotOptimize(extractor.extract(clip().frames[++i % clip().frames.size()]));
  }
}
BENCHMARK(features)->Apply(sizes);

void whole_frame(benchmark::State& state) {
  cv::setNumThreads(1);
  Config config;
  config.image = image_config(state);
  config.registration = reference_registration();
  config.registration.iterations = 500;
  TrackingRun run = make_tracking_run(config, clip().camera);
  run.scene.features.learn_background(clip().background);
  std::size_t i = 0;
  while (!run.state.calibrated() && i < clip().frames.size()) {
    track_frame(clip().frames[i++], run);
  }
  if (!run.state.calibrated()) {
    state.SkipWithError("the person was not calibrated");
    return;
  }
  for ([[maybe_unused]] const auto step : state) {
    benchmark::DoNotOptimize(track_frame(clip().frames[++i % clip().frames.size()], run));
  }
}
BENCHMARK(whole_frame)->Name("whole frame, 500 evaluations")->Apply(sizes);

}  // namespace
}  // namespace telemime
