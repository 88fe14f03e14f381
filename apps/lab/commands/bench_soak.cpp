// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <initializer_list>
#include <iomanip>
#include <iostream>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

#include "commands.h"
#include "lab/experiments/table.h"
#include "telemime/core/errors.h"
#include "telemime/likelihood/all.h"
#include "telemime/search/budget.h"

namespace telemime {
namespace {

// Number of calls of operator new on all threads. OpenCV's images and C code allocate without it.
std::atomic<std::uint64_t> allocations{0};

void* allocate(std::size_t size, std::size_t alignment) {
  allocations.fetch_add(1, std::memory_order_relaxed);
  void* const memory = std::aligned_alloc(alignment, (size / alignment + 1) * alignment);
  if (memory == nullptr) {
    throw std::bad_alloc();
  }
  return memory;
}

// Resident memory of this process, KiB.
long resident_kib() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.rfind("VmRSS:", 0) == 0) {
      return std::stol(line.substr(6));
    }
  }
  throw Error(ErrorKind::input, "/proc/self/status does not report the resident memory",
              "The soak test needs Linux.");
}

// The camera's view of several poses, in sequence.
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
  print({"part", "frames", "evaluations a second", "memory KiB", "new per frame"});
  const double start = steady_seconds();
  long first_kib = 0;
  long kib = 0;
  std::size_t t = 0;
  for (int tenth = 1; tenth <= kTenths; ++tenth) {
    const std::uint64_t allocations_before = allocations;
    const std::size_t before = t;
    const double began = steady_seconds();
    do {
      prepare(seen[t % seen.size()], camera, frame);
      backend->evaluate(frame, model, std::span(poses).subspan(t % 100, kBatch), Reduction::all, scores);
      ++t;
    } while (steady_seconds() - start < 60.0 * minutes * tenth / kTenths);
    const auto frames = static_cast<double>(t - before);
    const double taken = steady_seconds() - began;
    const auto allocated = static_cast<double>(allocations - allocations_before);
    kib = resident_kib();
    first_kib = tenth == 1 ? kib : first_kib;
    print({std::to_string(tenth) + "/" + std::to_string(kTenths), std::to_string(t - before),
           std::to_string(std::llround(frames * static_cast<double>(kBatch) / taken)), std::to_string(kib),
           number(allocated / frames)});
  }
  const double grown = static_cast<double>(kib - first_kib) / 1024.0;
  if (kib - first_kib > kMostKib) {
    throw std::runtime_error("memory grew by " + number(grown) + " MiB after the first tenth of the time");
  }
  std::cout << "memory grew by " << number(grown) << " MiB after the first tenth: at most 1 is allowed\n";
}

}  // namespace telemime

// The array and nothrow forms call these, and the library's operator delete calls free(). Inlined, the
// compiler would take allocation and release for a mismatch.
// NOLINTBEGIN(misc-new-delete-overloads)
[[gnu::noinline]] void* operator new(std::size_t size) {
  return telemime::allocate(size, alignof(std::max_align_t));
}
[[gnu::noinline]] void* operator new(std::size_t size, std::align_val_t alignment) {
  return telemime::allocate(size, static_cast<std::size_t>(alignment));
}
// NOLINTEND(misc-new-delete-overloads)
