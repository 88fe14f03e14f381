// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "telemime/offline/record_queue.h"

namespace telemime {

/// The generator for `fill_back`, by the seed of the configuration.
Random fill_back_seeds(const Config& config);

/// Takes up the record at the end of the queue. When it is the first in which a person was found, they are
/// followed back through the frames before it in which they are seen but were not tracked: a person who walks
/// in sideways, or bends over a chair, is hard to find but not hard to follow. A particle filter runs
/// backward in time from where they were found, until nobody is seen or the body no longer fits. Records wait
/// for that for TrackingConfig::fill_back (1/25 s). Returns the number of frames that are tracked now, too.
/// The same seed gives the same result for any number of threads.
std::size_t fill_back(const Tracker& tracker, const TrackerState& state, Random& seeds, RecordQueue& queue);

/// Leaves the frames that wait for `fill_back` as they are: no frame of the same person follows.
void end_fill_back(const Tracker& tracker, RecordQueue& queue);

}  // namespace telemime
