// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "telemime/capture/source.h"
#include "telemime/tracker/track_request.h"
#include "telemime/tracker/tracker_state.h"

namespace telemime {

/// Learns the background: from the clip of the empty room that the request names; else from the input itself,
/// which is opened and read once for that: from an empty stretch, from what its pixels return to while the
/// person moves, or not at all. Returns a sentence about what was learned. Throws Error(input) for a
/// background clip that cannot be used.
std::string learn_scene(const TrackRequest& request, const SourceInfo& info, TrackingRun& run);

}  // namespace telemime
