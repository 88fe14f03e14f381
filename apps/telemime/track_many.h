// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "telemime/offline/track_file.h"

namespace telemime {

/// A folder of its own below `out` for each input, named after its file; where names are the
/// same, also after its extension, its folder or a number.
std::vector<std::filesystem::path> folders_of(const std::vector<std::string>& inputs,
                                              const std::filesystem::path& out);

/// Options of track_many().
struct ManyOptions {
  int jobs = 1;        ///< files that are tracked at the same time
  bool again = false;  ///< also those whose results are there
  bool quiet = false;  ///< print errors only
  /// Tracks one file, in a process of its own; throws what track_file() throws.
  std::function<void(const TrackRequest&, const RunHooks&)> track;
};

/// Tracks several files, each in a process of its own, so that none can take the others with it. Files whose
/// results are there (finished_run) are left out. Prints one line for each file. Returns the exit code of the
/// first that failed, or 0. Ctrl-C stops those that run, which keep what they have, and starts no more; then
/// throws Interrupted.
int track_many(const std::vector<TrackRequest>& requests, const ManyOptions& options);

}  // namespace telemime
