// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "telemime/tracker/track_frame.h"

namespace telemime {

/// From lost to found and back: while nobody is tracked, `find_person` searches the whole image at intervals;
/// while a person is tracked, `check_fit` or `check_unseen` decides after each frame whether that goes on.

/// Searches a frame for a person: calibrates a new person (thesis 3.3), or finds the pose of the known
/// person. Sets the phase, and the note if nobody is found.
void find_person(const FrameFeatures& features, const Tracker& tracker, TrackerState& state,
                 FrameEstimate& result);

/// Whether a pose with this score may be that of the person in the frame: its regions overlap with those of
/// the image, or its landmarks are where the networks see them.
bool fits(const Score& score, const PreparedFrame& frame, const Tracker& tracker);

/// Marks a person as lost who left the image, or whom the body has not fitted for TrackingConfig::patience.
void check_fit(const FrameFeatures& features, const Score& score, const Tracker& tracker, TrackerState& state,
               FrameEstimate& result);

/// The same in a frame in which neither colours nor landmarks show the body, so that no pose was searched.
void check_unseen(const FrameFeatures& features, const Tracker& tracker, TrackerState& state,
                  FrameEstimate& result);

/// Stops tracking until a search finds the person again; `reason` is part of a sentence for the user.
void mark_lost(const std::string& reason, const Tracker& tracker, TrackerState& state, FrameEstimate& result);

/// Makes `pose` the tracked pose of this frame.
void adopt(const Pose& pose, const Score& score, TrackerState& state, FrameEstimate& result);

}  // namespace telemime
