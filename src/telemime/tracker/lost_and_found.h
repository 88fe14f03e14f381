// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "telemime/tracker/track_frame.h"

namespace telemime {

/// What happens between "lost" and "found". While nobody is tracked, `find_person` searches the whole image
/// at intervals; while somebody is, `check_fit` decides after each frame whether the tracker still holds
/// them.

/// Searches for a person in a frame: calibrates a new person (thesis 3.3), else finds the pose of the known
/// person. Sets the phase, and the note when nobody is found.
void find_person(const FrameFeatures& features, const Tracker& tracker, TrackerState& state,
                 FrameEstimate& result);

/// Loses a person who left the picture, or whom the body has not fitted for TrackingConfig::patience.
void check_fit(const FrameFeatures& features, const Score& score, const Tracker& tracker, TrackerState& state,
               FrameEstimate& result);

/// Gives the person up until a search finds them again; `reason` is a sentence part for the user.
void lose(const std::string& reason, const Tracker& tracker, TrackerState& state, FrameEstimate& result);

/// Makes `pose` the tracked pose of this frame.
void adopt(const Pose& pose, const Score& score, TrackerState& state, FrameEstimate& result);

}  // namespace telemime
