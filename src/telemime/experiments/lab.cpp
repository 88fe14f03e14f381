// SPDX-License-Identifier: Apache-2.0
#include "telemime/experiments/lab.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <utility>

#include "telemime/core/errors.h"

namespace telemime {
namespace {

constexpr std::array<const char*, 4> kGestures = {"raising_arms", "joy", "exclaiming", "asking"};

Grid track_grid(const std::vector<PreparedSequence>& sequences, const LabOptions& options) {
  Grid grid;
  grid.steps =
      options.quick ? std::vector<double>{0, 100, 300} : std::vector<double>{0, 50, 100, 200, 350, 500};
  for (std::size_t s = 0; s < sequences.size(); ++s) {
    for (const double edge : grid.steps) {
      for (const double region : grid.steps) {
        GridCell cell;
        cell.sequence = s;
        cell.region = static_cast<int>(region);
        cell.edge = static_cast<int>(edge);
        grid.cells.push_back(cell);
      }
    }
  }
  // The longest runs first, so that no core waits long for the last one.
  std::vector<std::size_t> order(grid.cells.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    order[i] = i;
  }
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return grid.cells[a].region + grid.cells[a].edge > grid.cells[b].region + grid.cells[b].edge;
  });
  std::atomic<std::size_t> next{0};
  tbb::parallel_for(std::size_t{0}, order.size(), [&](std::size_t) {
    GridCell& cell = grid.cells[order[next++]];
    const Trace trace =
        track_sequence(sequences[cell.sequence], reference_with(cell.region, cell.edge), options.seed);
    cell.mean_region = mean_of(trace.region);
    cell.mean_contour = mean_of(trace.contour);
    cell.region_peaks = static_cast<double>(count_above(trace.region, options.peaks.region));
    cell.contour_peaks = static_cast<double>(count_above(trace.contour, options.peaks.contour));
    cell.error_2d = mean_of(trace.error_2d);
    cell.error_3d = mean_of(trace.error_3d);
  });
  return grid;
}

}  // namespace

Config experiment_config(std::uint64_t seed) {
  Config config;
  config.seed = seed;
  config.image.width = 160;
  config.image.height = 120;
  return config;
}

Lab::Lab(LabOptions options) : options_(std::move(options)) {
  if (!options_.seconds) {
    throw Error(ErrorKind::usage, "experiments need a clock");
  }
}

void Lab::say(const std::string& words) const {
  if (options_.progress) {
    options_.progress(words);
  }
}

const std::vector<PreparedSequence>& Lab::gestures() {
  if (gestures_.empty()) {
    say("preparing the four gestures at 160x120");
    std::vector<PreparedSequence> prepared(kGestures.size());
    tbb::parallel_for(std::size_t{0}, kGestures.size(), [&](std::size_t i) {
      const Clip clip = read_clip(options_.data / kGestures[i], options_.quick ? 24 : 0);
      prepared[i] = prepare_sequence(clip, experiment_config(options_.seed));
    });
    gestures_ = std::move(prepared);
  }
  return gestures_;
}

const PreparedSequence& Lab::gesture(const std::string& name) {
  for (const PreparedSequence& sequence : gestures()) {
    if (sequence.name == name) {
      return sequence;
    }
  }
  throw Error(ErrorKind::usage, "there is no sequence '" + name + "'");
}

const Clip& Lab::timing_clip() {
  if (!clip_) {
    clip_ = read_clip(options_.data / "joy", options_.quick ? 12 : 40);
  }
  return *clip_;
}

const Grid& Lab::grid() {
  if (!grid_) {
    const auto& sequences = gestures();
    say("tracking the four gestures over the grid of iterations");
    grid_ = track_grid(sequences, options_);
  }
  return *grid_;
}

QuadraticFit Lab::fit() {
  const Grid& g = grid();
  const std::size_t n = g.steps.size();
  std::vector<ErrorSample> samples;
  for (std::size_t e = 0; e < n; ++e) {
    for (std::size_t r = 0; r < n; ++r) {
      double sum = 0.0;
      for (std::size_t s = 0; s < kGestures.size(); ++s) {
        sum += g.at(s, e, r).error_2d;
      }
      samples.push_back({g.steps[r], g.steps[e], sum / static_cast<double>(kGestures.size())});
    }
  }
  return fit_quadratic(samples);
}

std::vector<Trace> track_all(const PreparedSequence& sequence,
                             const std::vector<RegistrationConfig>& searches, std::uint64_t seed) {
  std::vector<Trace> traces(searches.size());
  tbb::parallel_for(std::size_t{0}, searches.size(),
                    [&](std::size_t i) { traces[i] = track_sequence(sequence, searches[i], seed); });
  return traces;
}

}  // namespace telemime
