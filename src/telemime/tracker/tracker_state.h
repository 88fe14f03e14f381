// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "telemime/body/face_measures.h"
#include "telemime/body/limits.h"
#include "telemime/core/camera.h"
#include "telemime/core/random.h"
#include "telemime/image/face_finder.h"
#include "telemime/image/features.h"
#include "telemime/image/hand_finder.h"
#include "telemime/tracker/config.h"
#include "telemime/tracker/hands.h"
#include "telemime/tracking/particle_filter.h"

namespace telemime {

/// The result of a calibration, with which the person can be tracked again without calibrating.
struct CalibratedPerson {
  Shape shape;
  std::string scale_from;     ///< where the absolute scale comes from: a sentence part for reports
  std::string refusal;        ///< why the arms kept average proportions; empty: they were fitted
  Score score;                ///< of the pose that the shape was fitted with
  bool height_given = false;  ///< the scale is that of a height that the user gave
};

/// A person whose shape is known before tracking starts, and where tracking starts.
struct KnownStart {
  CalibratedPerson person;
  std::int64_t frame = 0;  ///< tracking starts here with `pose`, unless a search found the person earlier
  Pose pose;
  /// From this frame on the person was visible with the colours that are known, so that a search may find
  /// them although their shape could not be fitted yet.
  std::int64_t visible_since = frame;
};

enum class Phase {
  waiting,   ///< nobody is calibrated
  tracking,  ///< the person is tracked from frame to frame
  lost       ///< the person is known and searched for
};

/// Everything that `estimate` carries from frame to frame: plain data, so that a copy is a snapshot from
/// which tracking can continue.
struct TrackerState {
  Phase phase = Phase::waiting;
  std::optional<CalibratedPerson> person;
  std::optional<KnownStart> known_start;  ///< set before the first frame or never
  Model model;                            ///< of the person, or of an average body
  Pose pose;                              ///< of the last frame in which the person was tracked
  Pose previous;                          ///< of the one before
  FilterState filter;                     ///< particles; empty while nobody is tracked or the method has none
  std::optional<double> region_residual;  ///< F of the poses in the last frames, on average
  double heading = 0.0;                   ///< torsion of the root that the filter's last step predicted, rad
  Random random{1};                       ///< for every draw outside the filter
  HandState hands;                        ///< of the person

  NeutralFace neutral_face;  ///< of the person

  double time = 0.0;                ///< of the last frame, s
  double elapsed = 1.0;             ///< time that the last frame stands for, in 1/25 s, at most 8
  double estimated = 0.0;           ///< time of the last frame that showed anything of a body, s
  double steps = 1.0;               ///< since that frame, in 1/25 s (steps_between)
  double steps_before = 1.0;        ///< between the last two such frames
  int bad_frames = 0;               ///< in a row: frames that the body does not fit
  double bad_for = 0.0;             ///< how long that has lasted, in 1/25 s
  double steps_until_search = 0.0;  ///< while not tracking, until the next search, in 1/25 s
  double lost_for = 0.0;            ///< since the person was last tracked, pauses included, in 1/25 s
  std::string reason;               ///< why the last search found nobody, or why the person was lost
  double waited = 0.0;              ///< with a head since the person was last tracked, in 1/25 s

  bool calibrated() const { return person.has_value(); }
};

/// What stays the same for a whole run: the settings, the cameras, the limits, the evaluation of poses.
struct Tracker {
  Config config;
  Camera camera;          ///< of the input's frames
  Camera working_camera;  ///< of the working image
  JointLimits limits;
  std::unique_ptr<Backend> backend;        ///< evaluates single poses
  std::unique_ptr<Evaluators> evaluators;  ///< evaluates batches; null for the method two-step
  std::unique_ptr<ParticleFilter> filter;  ///< null for the method two-step
};

/// What `extract` carries from frame to frame: the scene, the person's colours, the head, the hands.
struct SceneState {
  FeatureExtractor features;
  FaceFinder face;             ///< without networks where faces are not tracked
  HandFinder hands{};          ///< without networks where hands are not tracked
  bool hands_in_turn = false;  ///< one hand in a frame, when time is short
  int threads = 0;             ///< Config::threads
  /// The first frame from which on a head was visible, with the colours that are known now.
  std::int64_t head_since = 0;
  bool relearn_colours = false;  ///< the known colours may be somebody else's
  bool other_body = false;       ///< the known body is not that of the person who is followed now
};

/// A tracker and its state. `extract` changes only the scene and `estimate` only the state, so that two
/// threads can run them in parallel on consecutive frames.
struct TrackingRun {
  Tracker tracker;
  SceneState scene;
  TrackerState state;
};

/// `camera` is that of the input's frames. Throws Error(config).
TrackingRun make_tracking_run(const Config& config, const Camera& camera);

/// Uses the person and the scene that another run with the same camera calibrated.
void use_calibration(const CalibratedPerson& person, const ImageCalibration& image, TrackingRun& run);

/// Where somebody else is followed from this frame on (FrameFeatures::other_person), their colours are
/// learned, and if a body was calibrated, a warning says until the next calibration that it may not be
/// theirs.
void note_other_person(bool calibrated, SceneState& scene, FrameFeatures& features);

/// Forgets what is learned of a person in seconds: it may be somebody else who is seen now.
void forget_face_and_hands(TrackerState& state);

/// Forgets the person, but not the scene: the next frames calibrate the person that they show, with
/// their colours. Neither `extract` nor `estimate` may run at the same time.
void forget_person(TrackingRun& run);

}  // namespace telemime
