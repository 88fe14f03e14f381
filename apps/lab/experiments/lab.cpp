// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/lab.h"

#include <tbb/parallel_for.h>

#include <utility>

#include "lab/synth/actor.h"
#include "telemime/core/errors.h"

namespace telemime {
namespace {

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
  std::vector<double> lengths;
  for (const GridCell& cell : grid.cells) {
    lengths.push_back(cell.region + cell.edge);
  }
  longest_first(lengths, [&](std::size_t i) {
    GridCell& cell = grid.cells[i];
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

std::vector<double> Grid::plane(std::size_t sequence, double GridCell::*measure) const {
  std::vector<double> values;
  for (std::size_t i = 0; i < steps.size() * steps.size(); ++i) {
    values.push_back(cells[sequence * steps.size() * steps.size() + i].*measure);
  }
  return values;
}

std::vector<double> Grid::mean_plane(double GridCell::*measure) const {
  const std::size_t size = steps.size() * steps.size();
  std::vector<double> mean(size, 0.0);
  const auto repeats = static_cast<double>(cells.size()) / static_cast<double>(size);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    mean[i % size] += cells[i].*measure / repeats;
  }
  return mean;
}

FilterSetup filter_setup(const std::string& heuristics) {
  return heuristics == kOurFilter ? our_setup() : reference_setup(heuristics);
}

std::string filter_title(const std::string& heuristics) {
  return heuristics == kCondensation  ? "CONDENSATION"
         : heuristics == kAllTogether ? "all heuristics"
         : heuristics == kOurFilter   ? "our filter"
                                      : heuristics;
}

Config experiment_config(std::uint64_t seed) {
  Config config;
  config.seed = seed;
  config.image.width = 160;
  config.image.height = 120;
  config.cue_names = "regions,contours";  // what the thesis compares
  config.look_back = false;
  return config;
}

Lab::Lab(LabOptions options) : options_(std::move(options)) {
  if (!options_.seconds) {
    throw Error(ErrorKind::usage, "experiments need a clock");
  }
}

void Lab::log(const std::string& message) const {
  if (options_.progress) {
    options_.progress(message);
  }
}

const std::vector<PreparedSequence>& Lab::gestures() {
  if (gestures_.empty()) {
    log("preparing the four gestures at 160x120");
    std::vector<PreparedSequence> prepared(kThesisGestures.size());
    tbb::parallel_for(std::size_t{0}, kThesisGestures.size(), [&](std::size_t i) {
      const Clip clip = read_clip(options_.data / kThesisGestures[i], options_.quick ? 24 : 0);
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
    log("tracking the four gestures over the grid of iterations");
    grid_ = track_grid(sequences, options_);
  }
  return *grid_;
}

std::size_t Lab::seeds() const {
  return static_cast<std::size_t>(options_.seeds > 0 ? options_.seeds : options_.quick ? 2 : 5);
}

FilterSweep Lab::sweep_gestures(
    std::vector<int> particles,
    const std::function<Trace(const PreparedSequence&, int, std::uint64_t)>& track) {
  const auto& sequences = gestures();
  std::vector<double> lengths;
  for (const PreparedSequence& sequence : sequences) {
    lengths.push_back(static_cast<double>(sequence.frames.size()));
  }
  return sweep<FilterRun>(lengths, std::move(particles), options_.seed, seeds(),
                          [&](std::size_t s, int count, std::uint64_t seed) {
                            return summary_of(track(sequences[s], count, seed), options_.peaks);
                          });
}

const FilterSweep& Lab::filter(const std::string& heuristics) {
  const auto known = filters_.find(heuristics);
  if (known != filters_.end()) {
    return known->second;
  }
  gestures();
  const std::vector<int> particles =
      options_.quick ? std::vector<int>{100, 300}
                     : std::vector<int>{100, 200, 300, 400, 500, 600, 700, 800, 900, 1000};
  log("tracking the four gestures with " + filter_title(heuristics) + ", up to " +
      std::to_string(particles.back()) + " particles");
  const auto track = [&](const PreparedSequence& sequence, int count, std::uint64_t seed) {
    FilterSetup setup = filter_setup(heuristics);
    setup.filter.particles = count;
    return track_filter(sequence, setup, seed);
  };
  return filters_.emplace(heuristics, sweep_gestures(particles, track)).first->second;
}

std::vector<ErrorSample> Lab::error_samples() {
  const Grid& g = grid();
  const std::vector<double> errors = g.mean_plane(&GridCell::error_2d);
  std::vector<ErrorSample> samples;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    samples.push_back({g.steps[i % g.steps.size()], g.steps[i / g.steps.size()], errors[i]});
  }
  return samples;
}

std::vector<Trace> track_all(const PreparedSequence& sequence,
                             const std::vector<RegistrationConfig>& searches, std::uint64_t seed) {
  std::vector<Trace> traces(searches.size());
  tbb::parallel_for(std::size_t{0}, searches.size(),
                    [&](std::size_t i) { traces[i] = track_sequence(sequence, searches[i], seed); });
  return traces;
}

}  // namespace telemime
