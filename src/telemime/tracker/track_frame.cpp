// SPDX-License-Identifier: Apache-2.0
// The method: `extract` is the image side and `estimate` the search side of one frame. All their state is in
// SceneState and TrackerState.
#include "telemime/tracker/track_frame.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "telemime/body/face_expression.h"
#include "telemime/core/in_parallel.h"
#include "telemime/core/stopwatch.h"
#include "telemime/core/time_base.h"
#include "telemime/likelihood/cues/region.h"
#include "telemime/tracker/lost_and_found.h"
#include "telemime/tracking/posterior.h"

namespace telemime {
namespace {

// 1/25 s with a head but no face (a mask), after each of which the person's colours are learned again.
constexpr double kFaceless = 31.25;
constexpr double kLeastSteps = 0.2;  // between two frames
constexpr double kMostSteps = 8.0;   // after a longer gap the motion model says nothing
constexpr double kNearest = 0.01;    // m, of a joint that is projected

// Learns the person's colours from a frame that shows their face. Returns whether colours are known now.
bool learn_colours(const Frame& frame, ColourRequest request, SceneState& scene, FrameFeatures& features) {
  // A person whom landmarks found may be tracked before their colours are known: they are learned meanwhile.
  constexpr std::int64_t kEvery = 5;
  const auto known = [&scene] {
    return scene.features.calibration().colours.known() && !scene.relearn_colours;
  };
  if (request == ColourRequest::keep && (known() || frame.index % kEvery != 0)) {
    return known();
  }
  // Colours that were learned while a person without a face was still walking are learned again.
  const bool faceless = request == ColourRequest::learn_faceless;
  if (known() && !faceless) {
    return true;
  }
  const PersonReport report = scene.features.learn_person(frame);
  features.note = report.reason;
  features.face_learned = report.accepted;
  if (report.accepted) {
    scene.head_since = frame.index;
    scene.relearn_colours = false;
  }
  if (faceless) {
    scene.relearn_colours = false;  // where nothing else is learned, what is known must do
  }
  return known();
}

template <typename T>
struct Timed {
  T found{};
  double ms = 0.0;
};

// Looks where face and hands were, without the pose of the body. Both return the time, ms.
double prepare_face(const Frame& frame, SceneState& scene) {
  Stopwatch watch;
  scene.face.prepare(frame.image, frame.time);
  return watch.lap();
}

double prepare_hands(const Frame& frame, SceneState& scene) {
  Stopwatch watch;
  scene.hands.prepare(frame.image, frame.time, scene.hands_in_turn);
  return watch.lap();
}

// The face of the person (docs/face.md).
Timed<std::optional<FaceLandmarks>> find_face(const Frame& frame,
                                              const std::optional<PoseLandmarks>& landmarks,
                                              SceneState& scene) {
  if (!scene.face.has_networks() || !landmarks) {
    return {};
  }
  Stopwatch watch;
  auto face = scene.face.find(frame.image, *landmarks, scene.features.working_size(), frame.time);
  return {.found = std::move(face), .ms = watch.lap()};
}

// The hands of the person (docs/hands.md).
Timed<std::array<SeenHand, 2>> find_hands(const Frame& frame, const std::optional<PoseLandmarks>& landmarks,
                                          SceneState& scene) {
  if (!scene.hands.has_networks()) {
    return {};
  }
  if (!landmarks) {
    const SeenHand nowhere{.looked = true, .found = {}};
    return {.found = {nowhere, nowhere}};
  }
  Stopwatch watch;
  auto hands = scene.hands.find(frame.image, *landmarks, scene.features.working_size(), frame.time,
                                scene.hands_in_turn);
  return {.found = std::move(hands), .ms = watch.lap()};
}

// The estimate of a frame before its search: the last pose.
FrameEstimate begin_estimate(const FrameFeatures& features, const TrackerState& state) {
  FrameEstimate result;
  result.motion.frame = features.frame;
  result.motion.time = features.time;
  result.motion.pose = state.pose;
  result.motion.stage_ms.emplace_back("features", features.ms);
  if (features.networks_ms > 0.0) {
    result.motion.stage_ms.emplace_back("networks", features.networks_ms);
  }
  if (features.face_ms > 0.0) {
    result.motion.stage_ms.emplace_back("face", features.face_ms);
  }
  if (features.hands) {
    result.motion.stage_ms.emplace_back("hands", features.hands_ms);
  }
  result.note = features.note;
  return result;
}

// Head, eyes and expression (docs/face.md); nothing if no face is seen.
std::optional<FaceMotion> face_of(const FrameFeatures& features, const Camera& camera, TrackerState& state) {
  if (!features.face) {
    return std::nullopt;
  }
  static_assert(kFacePoints == FaceLandmarks::kCount);
  // While the person is lost, the face may be somebody else's, from whom nothing is learned.
  std::optional<NeutralFace> kept;
  if (state.phase == Phase::lost) {
    kept = state.neutral_face;
  }
  NeutralFace& neutral = kept ? *kept : state.neutral_face;
  const auto motion_of = [&](const std::array<FaceLandmark, FaceLandmarks::kCount>& seen) {
    FacePoints points;
    for (std::size_t i = 0; i < kFacePoints; ++i) {
      points[i] = {seen[i].pixel.x(), seen[i].pixel.y(), seen[i].depth};
    }
    return face_motion(points, features.face->presence, camera, features.time, neutral);
  };
  FaceMotion face = motion_of(features.face->points);
  if (features.face->again) {
    face = mean_of_looks(face, motion_of(*features.face->again));
  }
  return face.confidence > 0.0 ? std::optional(face) : std::nullopt;
}

// After a pause the last pose says nothing: the person is searched for as after a loss, in this frame.
void advance_time(double time, const Tracker& tracker, TrackerState& state, FrameEstimate& result) {
  const double passed = units_between(state.time, time);
  state.elapsed = std::min(passed, kMostSteps);
  state.lost_for += state.phase == Phase::lost ? passed : 0.0;
  state.steps = steps_between(state.estimated, time);
  if (time - state.time > kLongestGap) {
    if (state.phase == Phase::tracking) {
      mark_lost("the input has a pause", tracker, state, result);
      state.lost_for = passed;
    }
    state.steps_until_search = 0.0;
  }
  state.time = time;
}

bool search_is_due(std::int64_t frame, TrackerState& state) {
  state.waited += state.elapsed;
  state.steps_until_search -= state.elapsed;
  return state.steps_until_search <= 0.0 || (state.known_start && frame == state.known_start->frame);
}

// One step of the particle filter (thesis 4.4): the stages are in ParticleFilter::step.
Score follow_with_filter(const Tracker& tracker, double effort, TrackerState& state, FrameEstimate& result) {
  if (!state.filter.started()) {
    start_filter(state.pose, tracker.limits, state.filter);
  }
  const FilterResult found = tracker.filter->step({.frame = *result.prepared,
                                                   .model = state.model,
                                                   .velocity = tracker.config.tracking.velocity,
                                                   .effort = effort,
                                                   .time_step = state.steps},
                                                  state.filter);
  result.motion.evaluations += found.evaluations;
  result.motion.spread = spread_of_filter(tracker, state, *result.prepared, state.filter, found);
  state.heading = found.heading;
  state.previous = std::exchange(state.pose, found.pose);
  return found.score;
}

// The two-step registration alone (thesis 2.4.4.4, 3.5.4): from the predicted pose or the last one, whichever
// fits better.
Score follow_with_registration(const Tracker& tracker, double effort, TrackerState& state,
                               FrameEstimate& result) {
  RegistrationConfig search = for_time_step(tracker.config.registration, state.steps);
  search.iterations = std::max(1, static_cast<int>(std::lround(effort * search.iterations)));
  const double velocity = share_of_motion(tracker.config.tracking.velocity, state.steps, state.steps_before);
  const Pose predicted =
      predict_pose(state.pose, state.previous, velocity, state.steps_before, tracker.limits);
  // The start is chosen without a prior, and then becomes the prior of the search.
  Objective by_image(*tracker.backend, *result.prepared, state.model, tracker.limits);
  const bool moved = by_image(predicted, search.region) < by_image(state.pose, search.region);
  const Pose start = moved ? predicted : state.pose;
  Objective objective(*tracker.backend, *result.prepared, state.model, tracker.limits,
                      prior_at(state.model.body, start));
  const RegistrationResult found = register_pose(objective, start, search, state.random);
  result.motion.evaluations += by_image.evaluations() + objective.evaluations();
  result.motion.stage_ms.emplace_back("regions", found.region_ms);
  result.motion.stage_ms.emplace_back("edges", found.edge_ms);
  state.previous = std::exchange(state.pose, found.pose);
  return found.score;
}

// F of the poses in about the last half second, as far as colours were known.
void follow_residual(const PreparedFrame& frame, const Score& score, TrackerState& state) {
  constexpr double kRemembered = 12.5;  // 1/25 s
  if (!frame.has_colours) {
    return;
  }
  const double before = state.region_residual.value_or(score.region());
  const double kept = std::exp(-state.elapsed / kRemembered);
  state.region_residual = kept * before + (1.0 - kept) * score.region();
}

// The hands at the wrists of the pose that was found; at rest while nobody is tracked.
HandMotions hands_of(const FrameFeatures& features, const Tracker& tracker, TrackerState& state) {
  const SeenHand nobody{.looked = true, .found = {}};
  return observe_hands(state.phase == Phase::tracking ? *features.hands : std::array{nobody, nobody},
                       {.body = state.model.body,
                        .kinematics = forward_kinematics(state.model.body, state.pose),
                        .camera = tracker.working_camera,
                        .time = features.time},
                       state.hands);
}

// The best pose of each mode of the posterior, for the passes over a whole file.
std::vector<Pose> modes_of(const Tracker& tracker, const TrackerState& state) {
  return state.filter.started()
             ? mode_poses(tracker.config.filter, state.filter.particles, state.model.body, state.pose)
             : std::vector{state.pose};
}

}  // namespace

ColourRequest colour_request(const TrackerState& state) {
  if (state.calibrated()) {
    return ColourRequest::keep;
  }
  // Once in each such time.
  const double before = state.waited - state.elapsed;
  const bool faceless = state.phase == Phase::waiting && state.waited >= kFaceless &&
                        std::floor(state.waited / kFaceless) > std::floor(before / kFaceless);
  return faceless ? ColourRequest::learn_faceless : ColourRequest::learn;
}

FrameFeatures extract(const Frame& frame, ColourRequest request, SceneState& scene) {
  Stopwatch watch;
  FrameFeatures learned;
  bool has_colours = false;
  std::optional<PoseLandmarks> landmarks;
  FrameFeatures features;
  Timed<std::optional<FaceLandmarks>> face;
  Timed<std::array<SeenHand, 2>> hands;
  double face_ms = 0.0;
  double hands_ms = 0.0;
  on_threads(scene.threads, [&] {
    // The colours of skin, clothes and hair (thesis 3.4), while nobody is calibrated.
    has_colours = learn_colours(frame, request, scene, learned);
    // Labels, silhouette, edges, distance map and head (thesis 2.4.4.1, 3.5.1). What needs no landmarks of
    // the body runs beside the network that finds them: colours, edges, and a look at where face and hands
    // (docs/hands.md) were. The rest needs only the landmarks.
    in_parallel([&] { landmarks = scene.features.find_landmarks(frame); },
                [&] {
                  in_parallel([&] { scene.features.prepare(frame); },
                              [&] { hands_ms = prepare_hands(frame, scene); },
                              [&] { face_ms = prepare_face(frame, scene); });
                });
    in_parallel([&] { features = scene.features.extract(frame); },
                [&] { face = find_face(frame, landmarks, scene); },
                [&] { hands = find_hands(frame, landmarks, scene); });
  });
  features.face = face.found;
  features.face_ms = face_ms + face.ms;
  if (scene.hands.has_networks()) {
    features.hands = hands.found;
    features.hands_ms = hands_ms + hands.ms;
  }
  // Whether a person is present, and warnings where the assumptions of the scene model do not hold.
  features.warnings = scene.features.status().warnings;
  features.person_present = scene.features.status().person;
  features.other_person = scene.features.status().other_person;
  note_other_person(request == ColourRequest::keep, scene, features);
  features.note = learned.note;
  features.face_learned = learned.face_learned;
  // Without colours, skin and clothes look alike: only landmarks and outlines help.
  features.has_colour_model = has_colours && has_colour(scene.features.status());
  if (!has_colour(scene.features.status()) && !features.landmarks) {
    features.note =
        "the image has no colour, and no network sees a person in it: more light or a colour camera helps";
  }
  if (!features.head) {
    scene.head_since = frame.index + 1;
  }
  features.frame = frame.index;
  features.time = frame.time;
  features.ms = watch.lap();
  return features;
}

FrameEstimate estimate(const FrameFeatures& features, const Tracker& tracker, TrackerState& state,
                       double effort) {
  Stopwatch watch;
  FrameEstimate result = begin_estimate(features, state);
  advance_time(features.time, tracker, state, result);
  if (features.other_person) {
    forget_face_and_hands(state);
    state.region_residual.reset();
  }
  if (features.has_colour_model || features.landmarks) {
    // Class counts, tiles and distance map in the form that the likelihood reads (thesis 3.6).
    result.prepared = prepare(features, tracker.working_camera);
    // Without landmarks nothing else could lead, so the labels are trusted then.
    if (features.landmarks && state.region_residual) {
      result.prepared->label_reliability = label_reliability(*state.region_residual);
    }
    if (state.phase == Phase::tracking) {
      // Predict, propose, score, resample and refine the hypotheses; choose a pose (thesis 3.5, 4.4).
      const Score score = tracker.filter ? follow_with_filter(tracker, effort, state, result)
                                         : follow_with_registration(tracker, effort, state, result);
      adopt(state.pose, score, state, result);
      follow_residual(*result.prepared, score, state);
      // Lost: nobody is in the image, or the body no longer fits.
      check_fit(features, score, tracker, state, result);
    } else if (search_is_due(features.frame, state)) {
      // Found: the first frame to which the body can be fitted (thesis 3.3), or the known person again.
      find_person(features, tracker, state, result);
    }
    state.estimated = features.time;
    state.steps_before = state.steps;
  } else if (state.phase == Phase::tracking) {
    // Nothing shows the body: the last pose stays for a moment.
    check_unseen(features, tracker, state, result);
  }
  const bool tracking = state.phase == Phase::tracking;
  if (!tracking && (result.prepared || result.note.empty()) && !state.reason.empty()) {
    result.note = state.reason;  // also between two searches
  }
  // Poses for the passes over a whole file.
  if (tracking && tracker.config.look_back) {
    result.heading = state.heading;
    result.modes = modes_of(tracker, state);
  }
  // Joints in metres, and their pixels in the input's frame.
  result.motion.state = tracking ? TrackState::tracking : TrackState::lost;
  result.motion.pose = state.pose;
  place_joints(state.model.body, tracker.camera, result.motion);
  result.motion.face = face_of(features, tracker.camera, state);
  if (features.hands) {
    result.motion.hands = hands_of(features, tracker, state);
  }
  result.motion.stage_ms.emplace_back("search", watch.lap());
  return result;
}

FrameRecord track_frame(const Frame& frame, TrackingRun& run) {
  FrameRecord record{.frame = frame, .features = {}, .estimate = {}};
  record.features = extract(frame, colour_request(run.state), run.scene);
  record.estimate = estimate(record.features, run.tracker, run.state);
  return record;
}

double steps_between(double before, double now) {
  return std::clamp(units_between(before, now), kLeastSteps, kMostSteps);
}

void place_joints(const Body& body, const Camera& camera, MotionFrame& motion) {
  const Kinematics kinematics = forward_kinematics(body, motion.pose);
  motion.joints = kinematics.joints;
  if (motion.hands) {
    place_hands(kinematics, *motion.hands);
  }
  for (std::size_t i = 0; i < kJointCount; ++i) {
    Eigen::Vector3d p = motion.joints.at[i];
    p.z() = std::max(p.z(), kNearest);
    motion.pixels[i] = camera.project(p);
  }
}

PoseSpread spread_of_filter(const Tracker& tracker, const TrackerState& state, const PreparedFrame& frame,
                            const FilterState& filter, const FilterResult& found) {
  const SpreadModel& model = tracker.filter->numbers().spread;
  const bool height_given = state.person && state.person->height_given;
  return spread_of({.body = state.model.body,
                    .camera = tracker.working_camera,
                    .region = frame.has_colours ? found.score.region() : 0.0,
                    .size = height_given ? model.size_given : model.size,
                    .landmarks = frame.landmarks.has_value()},
                   filter.particles, found.pose, model);
}

}  // namespace telemime
