// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>

#include "telemime/tracker/track_request.h"

namespace telemime {

/// What a request asks for, as report.json holds it: the input and what is known of it, the other files, the
/// outputs, the version of the program and all settings but the number of threads, on which no result
/// depends. Of files that are read it holds size and time, of folders and patterns of images their digest, so
/// that others of the same name are noticed.
nlohmann::json request_json(const TrackRequest& request);

/// What TrackRequest::out holds of a request.
enum class FinishedRun : std::uint8_t {
  none,            ///< no results of this request and these files, or not all
  nobody_tracked,  ///< all of them, of a run in which nobody was tracked
  complete
};

/// The results of the same request on the same files that are there: report.json says so, the run was not
/// interrupted and all its files exist. None of a stream, which may have changed.
FinishedRun finished_run(const TrackRequest& request);

}  // namespace telemime
