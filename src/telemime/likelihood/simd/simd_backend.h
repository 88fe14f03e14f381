// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "telemime/likelihood/backend.h"

namespace telemime {

/// How far each pose is evaluated. Earlier stages give no scores; they serve to measure what each costs.
enum class SimdStage { place, project, set_up, draw, sample, look_up, count };

struct SimdOptions {
  /// Threads that share a batch; scores do not depend on their number. 0: as many as the machine has, which
  /// is also the maximum.
  int threads = 1;
  /// One of simd_instruction_sets(); empty: the fastest.
  std::string instruction_set = {};
  SimdStage last_stage = SimdStage::count;
  CueTable cues = {};
};

/// Instruction sets that this processor and this build support, the fastest first.
std::vector<std::string> simd_instruction_sets();

/// Back end with vector instructions over vertices, surfaces and pixels: the scores of `scalar` up to
/// rounding, many times faster. For the same kinematics, scores are bit-identical on all processors with
/// fused multiply-add (AVX2, AVX-512, NEON), for any number of threads and any batch size; older processors
/// agree with each other. Throws Error(usage) for options that are not available.
std::unique_ptr<Backend> make_simd_backend(const SimdOptions& options = {});

}  // namespace telemime
