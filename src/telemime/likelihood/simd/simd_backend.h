// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "telemime/likelihood/backend.h"

namespace telemime {

/// How far each pose is taken. Earlier stages alone give no scores: they are for measuring what each costs.
enum class SimdStage { place, project, set_up, draw, sample, look_up, count };

struct SimdOptions {
  /// Threads that share a batch; scores do not depend on it. 0: as many as the machine has, which is the
  /// most.
  int threads = 1;
  /// One of simd_instruction_sets(); empty: the first.
  std::string instruction_set;
  SimdStage last_stage = SimdStage::count;
};

/// Instruction sets that this processor and this build can use, the fastest first.
std::vector<std::string> simd_instruction_sets();

/// The same scores as `scalar` up to rounding, many times faster: vector instructions over vertices, surfaces
/// and pixels. Scores are the same bits on all processors with fused multiply-add (AVX2, AVX-512, NEON), for
/// any number of threads and any batch size; on older ones they are the same bits among each other. Not to be
/// used by two threads at a time. Throws Error(usage) for options that are not offered.
std::unique_ptr<Backend> make_simd_backend(const SimdOptions& options = {});

}  // namespace telemime
