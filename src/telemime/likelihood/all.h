// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <string>

#include "telemime/likelihood/backend.h"

namespace telemime {

/// The machine's clock, s from some moment on.
double steady_seconds();

struct BackendOptions {
  /// Threads that share a batch, where the back end can; 0: as many as the machine has.
  int threads = 1;
  /// The clock by which `auto` measures, s.
  std::function<double()> seconds = steady_seconds;
};

/// A back end by name.
struct BackendKind {
  std::string_view name;
  std::string_view what;  ///< for help and documents
  std::unique_ptr<Backend> (*make)(const BackendOptions& options);
  /// Why it cannot run here, in words; empty: it can.
  std::string (*missing)();
};

/// Every back end, one line each.
inline constexpr std::size_t kBackendCount = 5;
extern const std::array<BackendKind, kBackendCount> kBackends;

/// "simd, opencl, ...".
std::string backend_names();

/// Throws Error(usage): for an unknown name with the choices, for one that cannot run here with the reason.
std::unique_ptr<Backend> make_backend(std::string_view name, const BackendOptions& options = {});

}  // namespace telemime
