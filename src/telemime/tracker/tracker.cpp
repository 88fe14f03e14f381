// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracker/tracker.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "telemime/likelihood/all.h"
#include "telemime/tracking/posterior.h"

namespace telemime {
namespace {

// Frames in a row with a head but no face until the head's outline is taken.
constexpr int kFaceless = 25;

class Stopwatch {
 public:
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const double ms = std::chrono::duration<double, std::milli>(now - start_).count();
    start_ = now;
    return ms;
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

std::string scale_words(const CalibrationConfig& config) {
  return config.stature ? "the height given" : "an average adult's head (no height was given)";
}

constexpr double kRate = 25.0;  // frames a second that the motion model is made for

Config fitted_to(Config config, const Camera& camera) {
  config.validate();
  config = resolved(config);
  config.image = fitted_to(config.image, camera);
  return config;
}

}  // namespace

double steps_between(double before, double now) {
  const double steps = kRate * (now - before);
  // The clocks of cameras are not that exact.
  return std::abs(steps - 1.0) < 0.05 || !(steps > 0.0) ? 1.0 : std::clamp(steps, 0.2, 8.0);
}

void complete(MotionFrame& frame, const Body& body, const Camera& camera) {
  frame.joints = forward_kinematics(body, frame.pose).joints;
  for (std::size_t i = 0; i < kJointCount; ++i) {
    Eigen::Vector3d p = frame.joints.at[i];
    p.z() = std::max(p.z(), 0.01);
    frame.pixels[i] = camera.project(p);
  }
}

Tracker::Tracker(const Config& config, const Camera& camera)
    : config_(fitted_to(config, camera)),
      camera_(camera),
      working_camera_(camera.scaled_to(config_.image.width, config_.image.height)),
      limits_(load_limits(config.limits)),
      features_(config_.image),
      backend_(make_backend(config.backend, {.cues = config.cues})),
      random_(config.seed) {
  if (uses_filter(config_)) {
    evaluators_ = std::make_unique<Evaluators>(config_.backend, config_.threads, config_.cues);
    filter_ = std::make_unique<ParticleFilter>(config_.filter, config_.registration, limits_, *evaluators_,
                                               config_.seed);
  }
  Shape average;
  average.stature = config.calibration.stature.value_or(average.stature);
  model_ = make_model(average);
}

void Tracker::learn_background(std::span<const Frame> frames) {
  features_.learn_background(frames);
}

SceneReport Tracker::bootstrap(std::span<const Frame> clip) {
  return features_.bootstrap(clip);
}

void Tracker::set_scene(const ImageCalibration& scene) {
  features_.set_calibration(scene);
}

void Tracker::set_calibration(const TrackerCalibration& calibration, const ImageCalibration& image) {
  calibration_ = calibration;
  model_ = make_model(calibration.shape);
  features_.set_calibration(image);
  phase_ = Phase::lost;
  frames_until_search_ = 0.0;
}

void Tracker::set_effort(double share) {
  effort_ = share;
}

void Tracker::recalibrate() {
  known_.reset();
  calibration_.reset();
  colours_asked_ = true;
  if (filter_) {
    filter_->stop();
  }
  bad_frames_ = 0;
  bad_for_ = 0.0;
  facing_ = 0.0;
  phase_ = Phase::waiting;
  waited_ = 0;
  frames_until_search_ = 0.0;
}

void Tracker::person_colours(SeenFrame& seen) {
  // A masked face is never found: after a while the outline of the head must do, and colours that were
  // learned from somebody still walking are learned again.
  const bool again = phase_ == Phase::waiting && waited_ > 0 && waited_ % kFaceless == 0;
  if (features_.calibration().colours.known() && !again && !colours_asked_) {
    seen.coloured = true;
    return;
  }
  const PersonReport report = features_.learn_person(seen.frame);
  seen.note = report.reason;
  seen.face_just_seen = report.accepted;
  since_ = report.accepted ? seen.frame.index : since_;
  colours_asked_ = colours_asked_ && !report.accepted;
  seen.coloured = report.accepted || again;
}

void Tracker::look(const Frame& frame, bool settled, SeenFrame& seen) {
  Stopwatch watch;
  seen.frame = frame;
  seen.note.clear();
  seen.coloured = settled;
  seen.face_just_seen = false;
  if (!settled) {
    person_colours(seen);
  }
  seen.features = features_.extract(frame);
  seen.warnings = features_.status().warnings;
  seen.person = features_.status().person;
  if (!seen.features.head) {
    since_ = frame.index + 1;
  }
  if (seen.coloured) {
    prepare(seen.features, working_camera_, seen.prepared);
  }
  seen.ms = watch.lap();
}

TrackedFrame Tracker::step(const Frame& frame) {
  look(frame, settled(), seen_);
  return decide(seen_);
}

TrackedFrame Tracker::decide(SeenFrame& seen) {
  Stopwatch watch;
  TrackedFrame result;
  MotionFrame& motion = result.motion;
  motion.frame = seen.frame.index;
  motion.time = seen.frame.time;
  motion.pose = pose_;
  motion.stage_ms.emplace_back("features", seen.ms);
  result.note = seen.note;
  result.warnings = seen.warnings;
  steps_before_ = steps_;
  steps_ = steps_between(decided_, seen.frame.time);
  decided_ = seen.frame.time;
  if (seen.coloured) {
    if (phase_ == Phase::tracking && filter_) {
      follow_with_filter(seen, result);
    } else if (phase_ == Phase::tracking) {
      follow(seen, result);
    } else if (++waited_;
               (frames_until_search_ -= steps_) <= 0.0 || (known_ && motion.frame == known_->frame)) {
      search(seen, result);
    }
  }
  if (phase_ == Phase::tracking && config_.look_back) {
    const bool searched = filter_->started();
    std::vector<Pose> poses =
        searched ? mode_poses(config_.filter, *filter_, model_.body, pose_) : std::vector{pose_};
    const std::size_t count = poses.size();
    result.stretch = StretchFrame{std::exchange(seen.prepared, {}), facing_, std::move(poses), count};
  }
  motion.state = phase_ == Phase::tracking ? TrackState::tracking : TrackState::lost;
  motion.pose = pose_;
  complete(motion, model_.body, camera_);
  result.features = std::move(seen.features);
  motion.stage_ms.emplace_back("search", watch.lap());
  return result;
}

void Tracker::search(const SeenFrame& seen, TrackedFrame& result) {
  const FrameFeatures& features = seen.features;
  const PreparedFrame& prepared = seen.prepared;
  if (!features.head) {
    waited_ = 0;
    lose("nobody is found: the head must be in the picture", result);
    return;
  }
  if (known_ && result.motion.frame == known_->frame) {
    calibration_ = known_->person;
    model_ = make_model(known_->person.shape);
    phase_ = Phase::tracking;
    previous_ = known_->pose;
    Objective objective(*backend_, prepared, model_, limits_);
    adopt(known_->pose, objective.score(known_->pose, objective.cues().needs()), result);
    return;
  }
  if (!calibration_) {
    // Somebody in profile has a head, too, but no shape that could be fitted.
    if (!features.head->detected && !seen.face_just_seen) {
      lose("waiting for a face that looks at the camera", result);
      frames_until_search_ = 1.0;
      return;
    }
  }
  if (!calibration_ && known_ && result.motion.frame >= known_->since) {
    calibration_ = known_->person;
    model_ = make_model(known_->person.shape);
  }
  if (!calibration_) {
    const Calibration fit = calibrate(*backend_, prepared, *features.head, limits_, config_.calibration,
                                      config_.registration, random_);
    result.motion.evaluations += fit.evaluations;
    const bool patient = waited_ < config_.tracking.calibration_patience;
    if (fit.score.region() > config_.tracking.found_region || (!fit.refusal.empty() && patient)) {
      lose("waiting for a better first frame: " + fit.refusal, result);
      return;
    }
    calibration_ = TrackerCalibration{fit.shape, scale_words(config_.calibration), fit.refusal, fit.score,
                                      config_.calibration.stature.has_value()};
    model_ = make_model(fit.shape);
    phase_ = Phase::tracking;
    previous_ = fit.pose;
    adopt(fit.pose, fit.score, result);
    return;
  }
  Objective objective(*backend_, prepared, model_, limits_);
  const Pose found =
      initialise_pose(objective, *features.head, config_.calibration, config_.registration, random_);
  const Score score = objective.score(found, objective.cues().needs());
  result.motion.evaluations += objective.evaluations();
  if (score.region() > config_.tracking.found_region) {
    lose("somebody is there, but the body does not fit", result);
    return;
  }
  phase_ = Phase::tracking;
  previous_ = found;
  adopt(found, score, result);
}

void Tracker::follow(const SeenFrame& seen, TrackedFrame& result) {
  Objective image(*backend_, seen.prepared, model_, limits_);
  RegistrationConfig search = for_time_step(config_.registration, steps_);
  search.iterations = std::max(1, static_cast<int>(std::lround(effort_ * search.iterations)));
  const Pose predicted =
      predict_pose(pose_, previous_, config_.tracking.velocity * steps_ / steps_before_, limits_);
  const bool moves_on = image(predicted, search.region) < image(pose_, search.region);
  const Pose start = moves_on ? predicted : pose_;
  Objective objective(*backend_, seen.prepared, model_, limits_, prior_at(model_.body, start));
  const RegistrationResult found = register_pose(objective, start, search, random_);
  result.motion.evaluations += image.evaluations() + objective.evaluations();
  result.motion.stage_ms.emplace_back("regions", found.region_ms);
  result.motion.stage_ms.emplace_back("edges", found.edge_ms);
  previous_ = pose_;
  adopt(found.pose, found.score, result);
  watch(seen, found.score, result);
}

void Tracker::follow_with_filter(const SeenFrame& seen, TrackedFrame& result) {
  if (!filter_->started()) {
    filter_->start(pose_);
  }
  const FilterResult found = filter_->step({.frame = seen.prepared,
                                            .model = model_,
                                            .velocity = config_.tracking.velocity,
                                            .effort = effort_,
                                            .time_step = steps_});
  result.motion.evaluations += found.evaluations;
  result.motion.spread = spread(*filter_, found);
  facing_ = found.heading;
  previous_ = pose_;
  adopt(found.pose, found.score, result);
  watch(seen, found.score, result);
}

PoseSpread Tracker::spread(const ParticleFilter& filter, const FilterResult& found) const {
  const SpreadModel& spread = filter.numbers().spread;
  return spread_of({model_.body, working_camera_, found.score.region(),
                    calibration_ && calibration_->height_given ? spread.size_given : spread.size},
                   filter.particles(), found.pose, spread);
}

void Tracker::watch(const SeenFrame& seen, const Score& score, TrackedFrame& result) {
  if (!seen.person) {
    lose("nobody is in the picture", result);
    return;
  }
  const bool bad = score.region() > config_.tracking.lost_region || !seen.features.head;
  bad_frames_ = bad ? bad_frames_ + 1 : 0;
  bad_for_ = bad ? bad_for_ + steps_ : 0.0;
  // At a few frames a second one bad frame lasts as long as the patience.
  if (bad_for_ >= config_.tracking.patience && bad_frames_ >= std::min(2, config_.tracking.patience)) {
    lose("the body no longer fits the picture", result);
  }
}

void Tracker::adopt(const Pose& pose, const Score& score, TrackedFrame& result) {
  pose_ = pose;
  result.motion.region_score = score.region();
  result.motion.contour_score = score.contour();
  result.note.clear();
}

void Tracker::lose(const std::string& why, TrackedFrame& result) {
  phase_ = calibration_ ? Phase::lost : Phase::waiting;
  bad_frames_ = 0;
  bad_for_ = 0.0;
  if (filter_) {
    filter_->stop();
  }
  frames_until_search_ = config_.tracking.retry_every;
  result.note = why;
}

}  // namespace telemime
