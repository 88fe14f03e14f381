// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracker/lost_and_found.h"

#include <algorithm>
#include <cmath>

#include "telemime/search/calibration.h"

namespace telemime {
namespace {

// Whether a network sees the person where the body is: then the pose is accepted although regions disagree.
// A head alone says nothing of the body.
constexpr double kAgrees = 1.5;  // standard deviations, root mean square of the landmarks that are seen
constexpr std::ptrdiff_t kOfHead = 5;
bool landmarks_agree(const Score& score, const PreparedFrame& frame, const Tracker& tracker) {
  if (!frame.landmarks || !tracker.config.cues[cue::kLandmarks].enabled) {
    return false;
  }
  const auto& points = frame.landmarks->points;
  const auto seen = std::count_if(points.begin(), points.end(), [](const auto& p) { return p.seen; });
  // The cue's cost is a mean over all landmarks, in which one that is not seen counts as 0.
  const double share = static_cast<double>(seen) / static_cast<double>(points.size());
  return seen > kOfHead && score.costs[cue::kLandmarks] < kAgrees * std::sqrt(share);
}

// Counts the bad frames; true when they have lasted for TrackingConfig::patience. At a few frames per second
// one bad frame lasts as long as the patience.
bool is_out_of_patience(bool bad, const TrackingConfig& config, TrackerState& state) {
  state.bad_frames = bad ? state.bad_frames + 1 : 0;
  state.bad_for = bad ? state.bad_for + state.elapsed : 0.0;
  return state.bad_for >= config.patience && state.bad_frames >= std::min(2, config.patience);
}

std::string scale_source(const CalibrationConfig& config) {
  return config.stature ? "the height given" : "an average adult's head (no height was given)";
}

void set_person(const CalibratedPerson& person, TrackerState& state) {
  state.person = person;
  state.model = make_model(person.shape);
}

void start_tracking(const Pose& pose, const Score& score, TrackerState& state, FrameEstimate& result) {
  // Whoever comes back later may be somebody else; a face and hands are learned again in seconds.
  constexpr double kSurelyTheSame = 75.0;  // 1/25 s
  if (state.lost_for > kSurelyTheSame) {
    forget_face_and_hands(state);
  }
  state.lost_for = 0.0;
  state.heading = 0.0;
  state.phase = Phase::tracking;
  state.previous = pose;
  adopt(pose, score, state, result);
}

// Fits the shape and pose of a new person to one frame.
void calibrate_person(const FrameFeatures& features, const Tracker& tracker, TrackerState& state,
                      FrameEstimate& result) {
  const Config& config = tracker.config;
  // A person in profile also has a head, but no shape that could be fitted.
  if (!features.landmarks && !features.head->detected && !features.face_learned) {
    mark_lost("waiting for a face that looks at the camera", tracker, state, result);
    state.steps_until_search = 1.0;
    return;
  }
  const Calibration fit = calibrate(*tracker.backend, *result.prepared, *features.head, tracker.limits,
                                    config.calibration, config.registration, state.random);
  result.motion.evaluations += fit.evaluations;
  const bool patient = state.waited < config.tracking.calibration_patience;
  const bool agrees = landmarks_agree(fit.score, *result.prepared, tracker);
  if (!agrees && (fit.score.region() > config.tracking.found_region || (!fit.refusal.empty() && patient))) {
    mark_lost("waiting for a better first frame: " + fit.refusal, tracker, state, result);
    return;
  }
  set_person({.shape = fit.shape,
              .scale_from = scale_source(config.calibration),
              .refusal = fit.refusal,
              .score = fit.score,
              .height_given = config.calibration.stature.has_value()},
             state);
  start_tracking(fit.pose, fit.score, state, result);
}

}  // namespace

void find_person(const FrameFeatures& features, const Tracker& tracker, TrackerState& state,
                 FrameEstimate& result) {
  const std::int64_t frame = result.motion.frame;
  // Without a head there is nobody to search for.
  if (!features.head) {
    state.waited = 0.0;
    mark_lost("nobody is found: the head must be in the image", tracker, state, result);
    return;
  }
  // The frame for which the pose of a known person is given.
  if (state.known_start && frame == state.known_start->frame) {
    set_person(state.known_start->person, state);
    Objective objective(*tracker.backend, *result.prepared, state.model, tracker.limits);
    const Pose pose = state.known_start->pose;
    start_tracking(pose, objective.score(pose, objective.cues().needs()), state, result);
    return;
  }
  // A new person; one whose shape is known and who is already visible needs only a pose.
  if (!state.person) {
    if (state.known_start && frame >= state.known_start->visible_since &&
        (features.head->detected || features.face_learned)) {
      set_person(state.known_start->person, state);
    } else {
      calibrate_person(features, tracker, state, result);
      return;
    }
  }
  // Search the whole image for the pose of the known person.
  Objective objective(*tracker.backend, *result.prepared, state.model, tracker.limits);
  const Pose found = initialise_pose(objective, *features.head, tracker.config.calibration,
                                     tracker.config.registration, state.random);
  const Score score = objective.score(found, objective.cues().needs());
  result.motion.evaluations += objective.evaluations();
  if (score.region() > tracker.config.tracking.found_region &&
      !landmarks_agree(score, *result.prepared, tracker)) {
    mark_lost("a person is visible, but the body does not fit", tracker, state, result);
    return;
  }
  start_tracking(found, score, state, result);
}

bool fits(const Score& score, const PreparedFrame& frame, const Tracker& tracker) {
  return score.region() <= tracker.config.tracking.lost_region || landmarks_agree(score, frame, tracker);
}

void check_fit(const FrameFeatures& features, const Score& score, const Tracker& tracker, TrackerState& state,
               FrameEstimate& result) {
  if (!features.person_present) {
    mark_lost("nobody is in the image", tracker, state, result);
    return;
  }
  const TrackingConfig& config = tracker.config.tracking;
  const bool bad = !fits(score, *result.prepared, tracker) ||
                   (!features.head && !landmarks_agree(score, *result.prepared, tracker));
  if (is_out_of_patience(bad, config, state)) {
    mark_lost("the body no longer fits the image", tracker, state, result);
  }
}

void check_unseen(const FrameFeatures& features, const Tracker& tracker, TrackerState& state,
                  FrameEstimate& result) {
  if (!features.person_present) {
    mark_lost("nobody is in the image", tracker, state, result);
  } else if (is_out_of_patience(true, tracker.config.tracking, state)) {
    mark_lost("neither colours nor a network show the body", tracker, state, result);
  } else {
    adopt(state.pose, {}, state, result);  // nothing fits it
  }
}

void mark_lost(const std::string& reason, const Tracker& tracker, TrackerState& state,
               FrameEstimate& result) {
  state.phase = state.person ? Phase::lost : Phase::waiting;
  state.bad_frames = 0;
  state.bad_for = 0.0;
  state.filter.particles.clear();
  state.steps_until_search = tracker.config.tracking.retry_every;
  state.reason = reason;
  result.note = reason;
}

void adopt(const Pose& pose, const Score& score, TrackerState& state, FrameEstimate& result) {
  state.pose = pose;
  result.motion.region_score = score.region();
  result.motion.contour_score = score.contour();
  result.note.clear();
}

}  // namespace telemime
