// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>
#include <memory>
#include <optional>
#include <string>

#include "telemime/offline/run.h"

namespace telemime {

/// The options that `track` and `calibrate` share, as the user wrote them.
struct TrackOptions {
  TrackRequest request;
  std::string config_file;
  std::optional<double> field_of_view;
  std::optional<double> height;
  std::string size;
  std::string method;
  std::optional<int> particles;
  std::optional<std::string> heuristics;
  std::optional<int> threads;
  std::optional<int> iterations;
  std::optional<double> budget_ms;
  std::string limits;
  std::string backend;
  std::optional<std::uint64_t> seed;
  std::string smoothing;
  bool show = false;
  bool quiet = false;
  bool offline = false;
};

/// Adds INPUT and all options of tracking to a subcommand; `options` must outlive the parsing.
void add_track_options(CLI::App& command, TrackOptions& options);

/// The request that the options ask for: file first, then the command line. Throws Error(usage),
/// Error(config).
TrackRequest make_request(const TrackOptions& options);

}  // namespace telemime
