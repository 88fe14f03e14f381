// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "telemime/body/motion_frame.h"
#include "telemime/core/frame.h"
#include "telemime/image/frame_features.h"
#include "telemime/likelihood/backend.h"
#include "telemime/tracker/tracker_state.h"

namespace telemime {

/// What `estimate` finds in one frame.
struct FrameEstimate {
  MotionFrame motion;  ///< pose, scores, spread and times; not smoothed
  std::string note;    ///< why nobody is tracked; empty while tracking
  /// The frame made ready for scoring, for passes that look at it again; nothing while colours are unknown.
  std::optional<PreparedFrame> prepared;
  double heading = 0.0;     ///< torsion of the root that was predicted, rad
  std::vector<Pose> modes;  ///< best pose of each mode, the estimate first; where Config::look_back is set
};

/// One frame on its way from the input to the outputs. Passes over a deque of records fill in and change the
/// estimates; what no pass needs any more is released.
struct FrameRecord {
  Frame frame;
  FrameFeatures features;
  FrameEstimate estimate;
};

/// What `extract` may learn of the person's colours in a frame.
enum class ColourRequest {
  keep,           ///< a person is calibrated: their colours stay
  learn,          ///< learn them from a face, if they are not known
  learn_faceless  ///< a face has not been found for a while: colours that are known must do
};

/// What the search side asks of the next frame's `extract`.
ColourRequest colour_request(const TrackerState& state);

/// Image side (thesis 3.4, 3.5.1): labels, silhouette, edges, distance map and head of one frame. Frames must
/// come in the order of time.
FrameFeatures extract(const Frame& frame, ColourRequest request, SceneState& scene);

/// Search side (thesis 3.3, 3.5, 4.4): the pose of one frame. `effort`, above 0 and at most 1, is the share
/// of the configured evaluations that may be used.
FrameEstimate estimate(const FrameFeatures& features, const Tracker& tracker, TrackerState& state,
                       double effort = 1.0);

/// Both, one after the other.
FrameRecord track_frame(const Frame& frame, TrackingRun& run);

/// units_between as the motion model takes it: at least 0.2 and at most 8.
double steps_between(double before, double now);

/// Sets joints and pixels of a frame from its pose, and places its hands.
void place_joints(const Body& body, const Camera& camera, MotionFrame& motion);

/// Covariances of the joints about the estimate of a filter that follows `state.person`, in this frame.
PoseSpread spread_of_filter(const Tracker& tracker, const TrackerState& state, const PreparedFrame& frame,
                            const FilterState& filter, const FilterResult& found);

}  // namespace telemime
