// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <string>

#include "telemime/likelihood/backend.h"

namespace telemime {

/// Monotonic clock of the machine, s.
double steady_seconds();

struct BackendOptions {
  /// Threads that share a batch, in back ends that support it; 0: as many as the machine has.
  int threads = 1;
  /// Clock with which `auto` measures, s.
  std::function<double()> seconds = steady_seconds;
  CueTable cues = {};
};

/// A back end by name.
struct BackendKind {
  std::string_view name;
  std::string_view what;  ///< for help and documentation
  std::unique_ptr<Backend> (*make)(const BackendOptions& options);
  /// Why it cannot run here, for messages; empty: it can.
  std::string (*missing)();
};

/// All back ends, one line each.
inline constexpr std::size_t kBackendCount = 5;
extern const std::array<BackendKind, kBackendCount> kBackends;

/// Makes a back end by name. Throws Error(usage) for an unknown name, with the choices, and for a back end
/// that cannot run here, with the reason.
std::unique_ptr<Backend> make_backend(std::string_view name, const BackendOptions& options = {});

/// Gives each batch to the faster of two back ends. Which one that is, is measured once for every image size
/// and every batch size (in powers of two), with the first batch of its kind; all batches of a kind have the
/// scores of one of the two, until the device fails. `seconds` is a clock. `device` evaluates no batches of a
/// kind in which it counts otherwise than `processor` (except for rounding) or fails. The two agree up to
/// rounding, so that results may differ from run to run where both are about equally fast.
std::unique_ptr<Backend> make_auto_backend(std::unique_ptr<Backend> processor,
                                           std::unique_ptr<Backend> device, std::function<double()> seconds);

}  // namespace telemime
