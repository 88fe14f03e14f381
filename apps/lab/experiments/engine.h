// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lab/experiments/table.h"
#include "telemime/body/limits.h"
#include "telemime/core/random.h"
#include "telemime/likelihood/all.h"

namespace telemime {

/// Measurements of the evaluation engine: they need no clips.
struct EngineOptions {
  std::vector<std::string> backends;  ///< only these; empty: all that can run here
  bool quick = false;                 ///< short measurements and few poses: a check that it runs
  std::uint64_t seed = 1;
  int threads = 0;  ///< at most, for back ends that share a batch; 0: as many as the machine has
  std::function<double()> seconds;  ///< wall clock: devices and other threads count, too
};

/// Back ends to measure, without aliases unless they are named in the options. Throws
/// Error(usage) for names that are unknown or that cannot run here.
std::vector<std::string> engine_backends(const EngineOptions& options);

/// Threads that a batch may be shared between.
int most_threads(const EngineOptions& options);

/// Back ends that cannot run here, each with the reason: "name: reason".
std::vector<std::string> missing_backends();

/// The working images of all tables: 160x120, 320x240, 640x480.
std::vector<Camera> engine_cameras();

/// One person, one image, and poses around the pose in it as a search would try them.
struct EngineScene {
  Model model;
  PreparedFrame frame;
  std::vector<Pose> poses;
};
EngineScene engine_scene(const Camera& camera, std::size_t poses, std::uint64_t seed);

/// The time of one batch, s: the best of several, because other programs may be running.
struct BatchTime {
  double seconds = 0.0;
  std::optional<DeviceTimes> device;  ///< of its fastest batch
};

/// Evaluates batches of `batch` poses, taken in turn from the scene's, for about `budget` s, but at least
/// twice after a warm-up. `batch` is at most the number of poses.
BatchTime best_batch_time(Backend& backend, const EngineScene& scene, std::size_t batch, Reduction terms,
                          double budget, const std::function<double()>& seconds);

/// One cell of the table of speeds.
struct Throughput {
  std::string backend;
  std::string size;
  int threads = 1;
  std::size_t batch = 0;
  /// Empty where a batch would take too long.
  std::optional<BatchTime> time;
};

/// F and D_C together, from the pose to both scores, by back end, threads (one, and all where the back end
/// shares a batch between threads), working image and batch size.
std::vector<Throughput> measure_throughput(const EngineOptions& options);

/// Thousand evaluations a second, and microseconds for one; a column for each batch size.
Table speed_table(std::span<const Throughput> cells);
Table time_table(std::span<const Throughput> cells);

/// Upload, kernel and download times of a batch on a device; no rows when no back end reports them.
Table device_table(std::span<const Throughput> cells);

/// The time of each stage of `simd` and of `scalar` in one evaluation, on one thread, at the three image
/// sizes: the time up to a stage minus the time up to the previous one.
Table simd_stage_table(const EngineOptions& options);
Table scalar_stage_table(const EngineOptions& options);

/// One evaluation with each set of vector instructions that this processor has, on one thread.
Table instruction_set_table(const EngineOptions& options);

/// One evaluation with plain calls of OpenCV (see below) beside `simd`, one thread each.
Table opencv_table(const EngineOptions& options);

/// Thesis Table 4-1: 100 to 700 overlap histograms at 160x120, with the published times beside.
Table overlap_time_table(const EngineOptions& options);

/// The evaluation with OpenCV, to measure others against. Neither is exact: outlines are half a pixel wider.

/// The thesis step by step, each with the call that OpenCV has for it: vertices by cv::projectPoints, the
/// triangles that face the camera filled from the farthest to the nearest, images for the sets of
/// equation 2.5, the contour drawn as lines that nearer triangles paint over, its mean distance by cv::mean.
std::unique_ptr<Backend> make_literal_opencv();

/// The same optimised for speed: vertices projected by hand, segment after segment by one depth for each,
/// class and contour in one image, memory used again.
std::unique_ptr<Backend> make_fast_opencv();

/// Poses with every angle uniform within the limits, 1.0 to 1.6 m from the camera; poses with an arm inside
/// the body (kInvalidInterpenetration) are redrawn. Throws Error(usage) when the limits allow hardly any
/// other.
std::vector<Pose> valid_poses(const Body& body, const JointLimits& limits, std::size_t count, Random& random);

/// Three people: the default, a taller one with other proportions, a smaller one with longer sleeves.
std::array<Shape, 3> different_people();

/// Rank correlation of two equally long lists (C. Spearman, Am. J. Psychology 15, 1904), in [-1, 1]: the
/// correlation of their ranks, equal values taking the mean of theirs. 0 when all values of a list are equal.
/// Throws Error(usage) for other lengths.
double spearman(std::span<const double> a, std::span<const double> b);

/// Differences of two back ends' scores.
struct Agreement {
  std::size_t poses = 0;
  double region_max = 0.0, region_mean = 0.0;    ///< |dF|
  double contour_max = 0.0, contour_mean = 0.0;  ///< |dD_C|, px
};

/// `tested` against `reference` at 160x120 over `poses` random valid poses of the three people, each against
/// pictures of other poses.
Agreement compare_scores(Backend& reference, Backend& tested, std::size_t poses, std::uint64_t seed);

/// How two back ends rank poses near the true one: rank correlations over frames.
struct RankAgreement {
  double region_min = 1.0, region_mean = 0.0;
  double contour_min = 1.0, contour_mean = 0.0;
};

/// `frames` pictures of random valid poses; 200 poses about each, a few degrees and centimetres away.
RankAgreement compare_ranks(Backend& reference, Backend& tested, std::size_t frames, std::uint64_t seed);

/// Every back end of the options but `scalar` against it.
Table agreement_table(const EngineOptions& options);
Table ranking_table(const EngineOptions& options);

}  // namespace telemime
