// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <string>
#include <vector>

#include "telemime/capture/source.h"
#include "telemime/tracker/track_request.h"
#include "telemime/tracker/tracker.h"

namespace telemime {

/// What was read ahead of the tracking to learn the scene.
struct Footage {
  std::deque<Frame> ahead;            ///< frames of the input that were read and are still to be tracked
  std::vector<std::string> messages;  ///< how the background was learned, in words

  /// The next frame to track: first those read ahead.
  std::optional<Frame> next(Source& source);
};

/// Teaches the tracker the background: from the person-free clip, from a calibration, from the input's own
/// person-free start, from what its pixels return to while the person moves, or not at all (then the messages
/// say so). Throws Error(input) for a background clip that cannot be used.
Footage learn_scene(const TrackRequest& request, const SourceInfo& info, Source& source, Tracker& tracker);

}  // namespace telemime
