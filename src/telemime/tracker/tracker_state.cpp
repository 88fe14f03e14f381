// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracker/tracker_state.h"

#include "telemime/likelihood/all.h"
#include "telemime/nets/models/table.h"

namespace telemime {
namespace {

Config fitted_to(Config config, const Camera& camera) {
  config = resolved(config);
  config.image = fitted_to(config.image, camera);
  return config;
}

}  // namespace

TrackingRun make_tracking_run(const Config& config, const Camera& camera) {
  Config fitted = fitted_to(config, camera);
  SceneState scene{
      .features = FeatureExtractor(fitted.image), .face = {}, .hands = {}, .threads = fitted.threads};
  if (uses_face(fitted)) {
    scene.face = FaceFinder(find_models(fitted.image.models));
  }
  if (uses_hands(fitted)) {
    scene.hands = HandFinder(find_models(fitted.image.models));
  }
  const bool has_filter = uses_filter(fitted);
  Tracker tracker{.config = fitted,
                  .camera = camera,
                  .working_camera = camera.scaled_to(fitted.image.width, fitted.image.height),
                  .limits = load_limits(fitted.limits),
                  .backend = make_backend(fitted.backend, {.cues = fitted.cues}),
                  .evaluators = nullptr,
                  .filter = nullptr};
  if (has_filter) {
    tracker.evaluators = std::make_unique<Evaluators>(fitted.backend, fitted.threads, fitted.cues);
    tracker.filter = std::make_unique<ParticleFilter>(fitted.filter, fitted.registration, tracker.limits,
                                                      *tracker.evaluators);
  }
  Shape average;
  average.stature = config.calibration.stature.value_or(average.stature);
  TrackerState state;
  state.model = make_model(average);
  state.filter = FilterState(fitted.seed);
  state.random = Random(fitted.seed);
  return {.tracker = std::move(tracker), .scene = std::move(scene), .state = std::move(state)};
}

void use_calibration(const CalibratedPerson& person, const ImageCalibration& image, TrackingRun& run) {
  run.state.person = person;
  run.state.model = make_model(person.shape);
  run.state.phase = Phase::lost;
  run.state.steps_until_search = 0.0;
  run.scene.features.set_calibration(image);
}

void note_other_person(bool calibrated, SceneState& scene, FrameFeatures& features) {
  if (features.other_person) {
    scene.relearn_colours = true;
    scene.other_body = scene.other_body || calibrated;
  }
  if (scene.other_body) {
    features.warnings.emplace_back(
        "somebody else may be followed now, who is nearer to the camera: recalibrate to fit the body to "
        "them");
  }
}

void forget_face_and_hands(TrackerState& state) {
  state.neutral_face = {};
  state.hands = {};
}

void forget_person(TrackingRun& run) {
  run.scene.relearn_colours = true;
  run.scene.other_body = false;
  TrackerState& state = run.state;
  state.phase = Phase::waiting;
  state.person.reset();
  forget_face_and_hands(state);
  state.known_start.reset();
  state.filter.particles.clear();
  state.heading = 0.0;
  state.region_residual.reset();
  state.bad_frames = 0;
  state.bad_for = 0.0;
  state.lost_for = 0.0;
  state.waited = 0.0;
  state.reason.clear();
  state.steps_until_search = 0.0;
}

}  // namespace telemime
