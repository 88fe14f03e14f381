// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/experiments.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <opencv2/imgproc.hpp>

#include "lab/experiments/engine.h"
#include "lab/experiments/subtraction.h"
#include "telemime/core/errors.h"
#include "telemime/evaluation/error_means.h"

namespace telemime {
namespace {

constexpr double kMilliseconds = 1e3;

// Median time of the features of the timing clip's frames, in the steady state.
double measure_features(Lab& lab, const ImageConfig& config) {
  const Clip& clip = lab.timing_clip();
  FeatureExtractor features(config);
  features.learn_background(clip.background);
  const PersonReport person = features.learn_person(clip.frames.front());
  if (!person.accepted) {
    throw Error(ErrorKind::tracking, clip.name + ": " + person.reason,
                "Timings need a clip that starts with a face.");
  }
  std::vector<double> times;
  for (const Frame& frame : clip.frames) {
    const double start = lab.options().seconds();
    const FrameFeatures seen = features.extract(frame);
    times.push_back(kMilliseconds * (lab.options().seconds() - start));
  }
  return median_of(times);
}

}  // namespace

double median_of(std::vector<double> values) {
  return quantile(std::move(values), 0.5).value_or(0.0);
}

std::vector<FrameTime> measure_frame_times(Lab& lab) {
  const Config config = experiment_config(lab.options().seed);
  const double features_ms = measure_features(lab, config.image);
  const PreparedSequence sequence = prepare_sequence(lab.timing_clip(), config);
  const auto backend = make_scalar_backend();
  std::vector<FrameTime> result;
  for (const int count : {40, 100, 200, 300, 400, 500}) {
    const RegistrationConfig search = reference_with(count / 2, count - count / 2);
    Random random(lab.options().seed);
    Pose pose = sequence.start;
    std::vector<double> times;
    for (std::size_t t = sequence.first; t < sequence.frames.size(); ++t) {
      const double start = lab.options().seconds();
      Objective objective(*backend, sequence.frames[t], sequence.model, sequence.limits);
      pose = register_pose(objective, pose, search, random).pose;
      times.push_back(kMilliseconds * (lab.options().seconds() - start));
    }
    result.push_back({count, features_ms, median_of(times)});
  }
  return result;
}

EvaluationCost evaluation_cost(Lab& lab, int width, int height) {
  const auto backend = make_scalar_backend();
  Random random(lab.options().seed);
  return measure_cost(*backend, make_model(Shape{}), Camera{}.scaled_to(width, height),
                      lab.options().quick ? 3 : 9, random, lab.options().seconds);
}

std::vector<SizeTime> measure_sizes(Lab& lab) {
  constexpr std::array<std::array<int, 2>, 6> kSizes = {
      {{160, 120}, {256, 256}, {320, 240}, {480, 480}, {512, 512}, {640, 480}}};
  std::vector<SizeTime> times;
  times.reserve(kSizes.size());
  for (const auto& [width, height] : kSizes) {
    Config config = experiment_config(lab.options().seed);
    config.image.width = width;
    config.image.height = height;
    times.push_back({measure_features(lab, config.image), evaluation_cost(lab, width, height)});
  }
  return times;
}

Table background_time_table(Lab& lab) {
  const Clip& clip = lab.timing_clip();
  const auto small = [](const Frame& frame) {
    cv::Mat picture;
    cv::resize(frame.image, picture, cv::Size(160, 120), 0, 0, cv::INTER_AREA);
    return picture;
  };
  std::vector<cv::Mat> empty;
  std::vector<cv::Mat> pictures;
  std::transform(clip.background.begin(), clip.background.end(), std::back_inserter(empty), small);
  std::transform(clip.frames.begin(), clip.frames.end(), std::back_inserter(pictures), small);
  Table table{"Table 3-1: background subtraction at 160x120, ms", {"method", "ours ms"}, {}};
  for (const Subtraction method :
       {Subtraction::rgb_difference, Subtraction::mixture, Subtraction::reference, Subtraction::robust}) {
    const auto subtractor = make_subtractor(method, empty);
    std::vector<double> times;
    for (int repeat = 0; repeat < 3; ++repeat) {
      for (const cv::Mat& picture : pictures) {
        const double start = lab.options().seconds();
        const cv::Mat foreground = subtractor(picture);
        times.push_back(kMilliseconds * (lab.options().seconds() - start));
      }
    }
    table.rows.push_back(row_of(kSubtractionNames[static_cast<std::size_t>(method)], median_of(times)));
  }
  return beside(table, published_values("T3-1"));
}

Table frame_time_table(const std::vector<FrameTime>& times) {
  Table table{
      "Table 3-2: one frame at 160x120, ms", {"iterations", "features ms", "search ms", "frame ms"}, {}};
  for (const FrameTime& t : times) {
    table.rows.push_back(row_of(t.iterations, t.features_ms, t.search_ms, t.total_ms()));
  }
  return beside(table, published_values("T3-2"));
}

Table size_time_table(const std::vector<SizeTime>& times) {
  Table table{"Table 3-3: by working size", {"size", "features ms", "F us", "D_C us", "D_C : F"}, {}};
  for (const SizeTime& t : times) {
    table.rows.push_back(row_of(size_name(t.cost.width, t.cost.height), t.features_ms,
                                kMilliseconds * t.cost.region_ms, kMilliseconds * t.cost.edge_ms,
                                t.cost.edge_ms / t.cost.region_ms));
  }
  return beside(table, published_values("T3-3"));
}

Finding background_times(Lab& lab) {
  Finding finding;
  finding.tables = {background_time_table(lab)};
  const auto ms = [&](std::size_t row) { return std::stod(finding.tables[0].rows[row][1]); };
  finding.notes = {
      "All use the same opening and closing. 'reference' is the thesis's method, 'robust' the one that "
      "telemime uses."};
  finding.verdict = verdict({ms(0) < ms(1), ms(1) < ms(2)},
                            "RGB difference " + number(ms(0)) + " ms, mixture " + number(ms(1)) +
                                " ms, the thesis's " + number(ms(2)) + " ms, ours " + number(ms(3)) + " ms.");
  return finding;
}

Finding frame_times(Lab& lab) {
  const std::vector<FrameTime> times = measure_frame_times(lab);
  const double per_500 = times.back().total_ms();
  return {
      .tables = {frame_time_table(times)},
      .notes = {"With 500 evaluations a frame takes " + number(per_500) + " ms: " + number(1e3 / per_500) +
                " frames a second on one thread, features and search in sequence."},
      .verdict = verdict({times.back().search_ms > 3.0 * times.front().search_ms},
                         "the time grows in proportion to the evaluations, as published; a frame is " +
                             number(93.0 / per_500) + " times as fast as platform 1.")};
}

Finding size_times(Lab& lab) {
  const std::vector<SizeTime> times = measure_sizes(lab);
  const double first = times.front().cost.edge_ms / times.front().cost.region_ms;
  const double last = times.back().cost.edge_ms / times.back().cost.region_ms;
  return {.tables = {size_time_table(times)},
          .notes = {"The time of an evaluation grows more slowly than the number of pixels: part of it is "
                    "projecting the mesh, which has the same number of triangles at every size."},
          .verdict = verdict({first > last, times.back().features_ms > times.front().features_ms},
                             "D_C costs " + number(first) + " of an F at 160x120 and " + number(last) +
                                 " at 640x480 (thesis: 1.06 and 0.77).")};
}

Finding overlap_times(Lab& lab) {
  EngineOptions options;
  options.backends = {"scalar", "simd"};
  options.quick = lab.options().quick;
  options.seed = lab.options().seed;
  options.threads = 1;
  options.seconds = lab.options().seconds;
  Finding finding;
  finding.tables = {overlap_time_table(options)};
  const auto& rows = finding.tables.front().rows;
  const auto last = [&](std::size_t column) { return std::stod(rows.back()[column]); };
  finding.notes = {
      "From the poses to the histograms: placing the model, drawing it and counting the overlap. "
      "`telemime-lab bench --engine-only` measures the other back ends, devices among them, and all "
      "threads."};
  finding.verdict =
      verdict({last(2) < last(1), last(1) > 2.0 * std::stod(rows.front()[1])},
              rows.back()[0] + " histograms take " + number(last(1)) + " ms with scalar code and " +
                  number(last(2)) + " ms with vector instructions on one thread, " +
                  number(last(3) / last(2)) + " times as fast as the thesis's CPU and " +
                  number(last(5) / last(2)) + " times as fast as its first GPU.");
  return finding;
}

}  // namespace telemime
