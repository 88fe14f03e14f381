// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>
#include <ctime>
#include <filesystem>

namespace telemime {

/// `telemime-lab bench`: the thesis's tables of computing times beside the published values, and the back
/// ends.
void add_bench_command(CLI::App& app);

/// `telemime-lab experiments ID...`: tables and figures of the thesis, measured again.
void add_experiments_command(CLI::App& app);

/// `telemime-lab landmarks CLIP --out DIR`: pictures of what the networks find in a clip.
void add_landmarks_command(CLI::App& app);

/// `telemime-lab learn filter FOLDER... --out FILE`: the particle filter's parameters from sequences with
/// truth; `telemime-lab learn landmarks`: where networks see the landmarks of the model.
void add_learn_command(CLI::App& app);

/// `telemime-lab synth GESTURE --out DIR`: clips with exact truth.
void add_synth_command(CLI::App& app);

/// `telemime-lab tune`: the cost of one F and one D_C on this machine, and the best split of a time budget.
void add_tune_command(CLI::App& app);

/// Evaluates batches of 1000 poses against changing frames with `simd` on all threads for `minutes` and
/// prints memory and allocations ten times. Throws std::runtime_error when memory grew by more than 1 MiB
/// after the first tenth of the time.
void run_soak(double minutes);

/// The folder with the four gestures for measurements: `given`, else the development clips beside the
/// checkout, else clips that `telemime-lab synth` makes below `out` (320x240, kept for the next run).
std::filesystem::path measurement_data(const std::filesystem::path& given, const std::filesystem::path& out);

/// Processor time of the calling thread, s: independent of what other programs do.
inline double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace telemime
