// SPDX-License-Identifier: Apache-2.0
#include "bench_soak.h"

#include <cmath>
#include <fstream>
#include <initializer_list>
#include <iomanip>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "allocation_counter.h"
#include "lab/experiments/table.h"
#include "telemime/core/errors.h"
#include "telemime/likelihood/all.h"
#include "telemime/search/budget.h"

namespace telemime {
namespace {

// Memory of this program that is in the machine's, KiB.
long resident_kib() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.rfind("VmRSS:", 0) == 0) {
      return std::stol(line.substr(6));
    }
  }
  throw Error(ErrorKind::input, "/proc/self/status does not say how much memory is in use",
              "The soak test needs Linux.");
}

// What a camera would show of some poses, one after the other.
std::vector<FrameFeatures> soak_features(const Model& model, const Camera& camera,
                                         const std::vector<Pose>& poses) {
  constexpr std::size_t kFrames = 16;
  std::vector<FrameFeatures> seen;
  for (std::size_t i = 0; i < kFrames; ++i) {
    const PreparedFrame frame = frame_of_model(model, poses[i], camera);
    FrameFeatures features;
    features.labels = frame.labels;
    features.distance = frame.distance;
    seen.push_back(features);
  }
  return seen;
}

}  // namespace

void run_soak(double minutes) {
  constexpr std::size_t kBatch = 1000;
  constexpr int kTenths = 10;
  constexpr long kMostKib = 1024;
  const Camera camera = Camera{}.scaled_to(320, 240);
  const Model model = make_model(Shape{});
  Random random(1);
  const std::vector<Pose> poses = typical_poses(kBatch + 100, random);
  const std::vector<FrameFeatures> seen = soak_features(model, camera, poses);
  const auto backend = make_backend("simd", {0});
  std::vector<Score> scores(kBatch);
  PreparedFrame frame;
  std::cout << "simd on all threads, batches of " << kBatch << " at 320x240, for " << number(minutes)
            << " minutes\n";
  const auto print = [](std::initializer_list<std::string> fields) {
    for (const std::string& field : fields) {
      std::cout << std::setw(22) << field;
    }
    std::cout << std::endl;  // at once: the next line may be an hour away
  };
  print({"part", "frames", "evaluations a second", "memory KiB", "new for each frame"});
  const double start = steady_seconds();
  long first_kib = 0;
  long kib = 0;
  std::size_t t = 0;
  for (int tenth = 1; tenth <= kTenths; ++tenth) {
    const auto allocations = heap_allocations();
    const std::size_t before = t;
    const double began = steady_seconds();
    do {
      prepare(seen[t % seen.size()], camera, frame);
      backend->evaluate(frame, model, std::span(poses).subspan(t % 100, kBatch), Reduction::all, scores);
      ++t;
    } while (steady_seconds() - start < 60.0 * minutes * tenth / kTenths);
    const auto frames = static_cast<double>(t - before);
    const double taken = steady_seconds() - began;
    const auto allocated = heap_allocations();
    kib = resident_kib();
    first_kib = tenth == 1 ? kib : first_kib;
    print({std::to_string(tenth) + "/" + std::to_string(kTenths), std::to_string(t - before),
           std::to_string(std::llround(frames * static_cast<double>(kBatch) / taken)), std::to_string(kib),
           allocations ? number(static_cast<double>(*allocated - *allocations) / frames) : "-"});
  }
  const double grown = static_cast<double>(kib - first_kib) / 1024.0;
  if (kib - first_kib > kMostKib) {
    throw std::runtime_error("memory grew by " + number(grown) +
                             " MiB after the first tenth of the time: something is kept that should not be");
  }
  std::cout << "memory grew by " << number(grown) << " MiB after the first tenth: at most 1 is allowed\n";
}

}  // namespace telemime
