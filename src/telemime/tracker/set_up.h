// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "telemime/capture/source.h"
#include "telemime/core/lens.h"
#include "telemime/outputs/encoder.h"
#include "telemime/tracker/track_request.h"
#include "telemime/tracker/tracker_state.h"

namespace telemime {

/// The camera of an input: the calibration file scaled to its size, or the field of view. Throws
/// Error(config) for a calibration of another aspect ratio.
Camera camera_for(const SourceInfo& info, const std::string& file, double field_of_view);

/// The pictures of an input without the distortion that the request's camera or calibration file states.
/// Throws Error(config).
std::unique_ptr<Source> without_distortion(std::unique_ptr<Source> source, const TrackRequest& request);

/// The lens that without_distortion() uses, for pictures of this size; without distortion if no file states
/// one.
Lens lens_for(const SourceInfo& info, const TrackRequest& request);

/// The head of a stream of frames of the person who is tracked now.
StreamHeader header_of(const SourceInfo& info, const TrackingRun& run);

/// The configuration with a number of evaluations in the place of its time budget, by what one costs here and
/// now (thesis 3.6). Without a budget it comes back as it is.
Config with_budget(const Config& config, const Camera& camera);

/// The run that tracks an input. With a calibration file it knows the person and the scene; without one it
/// has still to learn the scene. Notes for the user are added to `messages`. Throws Error(config).
TrackingRun open_run(const TrackRequest& request, const SourceInfo& info, std::vector<std::string>& messages);

}  // namespace telemime
