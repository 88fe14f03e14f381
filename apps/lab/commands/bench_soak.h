// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace telemime {

/// Evaluates batches of 1000 poses against changing frames with `simd` on all threads for so many minutes and
/// prints memory and allocations each tenth of the time. Throws std::runtime_error in words when memory grew
/// by more than 1 MiB after the first tenth.
void run_soak(double minutes);

}  // namespace telemime
