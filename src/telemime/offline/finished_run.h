// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "telemime/tracker/track_request.h"

namespace telemime {

/// What a request asks for, as report.json holds it: the input and what is known of it, the other files, the
/// outputs, the version of the program and all settings but the number of threads, on which no result
/// depends.
nlohmann::json request_json(const TrackRequest& request);

/// Whether TrackRequest::out holds the results of the same request on the same input: its report.json says
/// so, the run was not interrupted, all its files are there and none of the files that were read is newer.
bool is_finished(const TrackRequest& request);

}  // namespace telemime
