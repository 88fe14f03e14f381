// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/sequence.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "telemime/capture/source.h"
#include "telemime/core/errors.h"
#include "telemime/evaluation/error_means.h"
#include "telemime/evaluation/motion_measures.h"
#include "telemime/likelihood/all.h"
#include "telemime/tracker/track_frame.h"
#include "telemime/tracking/particle_filter.h"

namespace telemime {
namespace {

constexpr double kMillimetres = 1e3;

std::vector<Frame> read_all(const std::filesystem::path& file, std::size_t most) {
  const auto source = open_source(file.string());
  std::vector<Frame> frames;
  while (most == 0 || frames.size() < most) {
    auto frame = source->next();
    if (!frame) {
      break;
    }
    frames.push_back(std::move(*frame));
  }
  return frames;
}

// Mean over elbows and wrists; NaN when the truth has none of them.
struct FrameMeans {
  double error_2d = std::numeric_limits<double>::quiet_NaN();
  double error_3d = std::numeric_limits<double>::quiet_NaN();
};

FrameMeans mean_errors(const MotionFrame& motion, const Camera& camera, const Truth& truth, std::size_t t) {
  const FrameErrors errors = measure_frame(motion, camera, truth.frames[t], truth.camera, 1.0);
  Mean flat;
  Mean deep;
  for (const Joint joint : kScoredJoints) {
    const auto& error = errors[static_cast<std::size_t>(joint)];
    if (error) {
      flat.add(error->pixels_at_depth);
      deep.add(error->aligned ? std::optional<double>(error->aligned->norm()) : std::nullopt);
    }
  }
  FrameMeans means;
  means.error_2d = flat.value().value_or(means.error_2d) * kMillimetres;
  means.error_3d = deep.value().value_or(means.error_3d) * kMillimetres;
  return means;
}

// Collects the trace of a run, frame by frame.
class Recorder {
 public:
  explicit Recorder(const PreparedSequence& sequence) : sequence_(sequence) {}

  void add(std::size_t t, const Pose& pose, const Score& score, int evaluations) {
    MotionFrame motion;
    motion.pose = pose;
    place_joints(sequence_.model.body, sequence_.camera, motion);
    const FrameMeans errors = mean_errors(motion, sequence_.camera, sequence_.truth, t);
    trace_.frame.push_back(static_cast<double>(t));
    trace_.region.push_back(score.region());
    trace_.contour.push_back(score.contour());
    trace_.error_2d.push_back(errors.error_2d);
    trace_.error_3d.push_back(errors.error_3d);
    trace_.evaluations.push_back(evaluations);
    joints_.emplace_back(as_truth(motion.joints));
  }

  Trace trace() const {
    Trace trace = trace_;
    trace.jitter = kMillimetres * wrist_jitter(joints_).value_or(std::numeric_limits<double>::quiet_NaN());
    return trace;
  }

 private:
  const PreparedSequence& sequence_;
  Trace trace_;
  JointTrack joints_;
};

}  // namespace

std::optional<std::filesystem::path> find_video(const std::filesystem::path& folder,
                                                const std::string& stem) {
  for (const char* ending : {".mp4", ".mkv", ".avi"}) {
    if (std::filesystem::exists(folder / (stem + ending))) {
      return folder / (stem + ending);
    }
  }
  return std::nullopt;
}

std::filesystem::path video_in(const std::filesystem::path& folder, const std::string& stem) {
  if (const auto found = find_video(folder, stem)) {
    return *found;
  }
  throw Error(ErrorKind::input, "there is no " + stem + ".mp4 or .mkv in " + folder.string(),
              "`telemime-lab synth all --out DIR` makes sequences; give DIR with --data.");
}

Clip read_clip(const std::filesystem::path& folder, std::size_t most_frames) {
  Clip clip;
  clip.name = folder.filename().string();
  clip.truth = read_truth(folder / "truth.json");
  clip.camera = clip.truth.camera;
  clip.background = read_all(video_in(folder, "background"), 0);
  clip.frames = read_all(video_in(folder, "video"), most_frames);
  clip.frames.resize(std::min(clip.frames.size(), clip.truth.frames.size()));
  return clip;
}

PreparedSequence prepare_sequence(const Clip& clip, const Config& config) {
  PreparedSequence sequence;
  sequence.name = clip.name;
  sequence.camera = clip.camera;
  sequence.truth = clip.truth;
  sequence.limits = load_limits(config.limits);
  const ImageConfig image = fitted_to(config.image, clip.camera);
  const Camera working = clip.camera.scaled_to(image.width, image.height);
  const auto backend = make_scalar_backend();
  Random random(config.seed);
  FeatureExtractor features(image);
  features.learn_background(clip.background);
  bool coloured = false;
  bool calibrated = false;
  std::string reason = "there is no frame";
  for (std::size_t t = 0; t < clip.frames.size(); ++t) {
    if (!coloured) {
      const PersonReport person = features.learn_person(clip.frames[t]);
      coloured = person.accepted;
      reason = person.reason;
    }
    const FrameFeatures seen = features.extract(clip.frames[t]);
    sequence.frames.push_back(prepare(seen, working));
    if (calibrated || !coloured || !seen.head) {
      continue;
    }
    const Calibration fit = calibrate(*backend, sequence.frames.back(), *seen.head, sequence.limits,
                                      config.calibration, config.registration, random);
    reason = fit.refusal;
    calibrated = fit.refusal.empty();
    sequence.first = t;
    sequence.model = make_model(fit.shape);
    sequence.start = fit.pose;
  }
  if (!calibrated) {
    throw Error(ErrorKind::tracking, clip.name + ": no frame can be calibrated: " + reason,
                "Use a clip that starts with a person who faces the camera, arms apart from the body.");
  }
  return sequence;
}

double mean_of(const std::vector<double>& values) {
  Mean mean;
  for (const double value : values) {
    mean.add(std::isfinite(value) ? std::optional<double>(value) : std::nullopt);
  }
  return mean.value().value_or(std::numeric_limits<double>::quiet_NaN());
}

std::size_t count_above(const std::vector<double>& values, double threshold) {
  return static_cast<std::size_t>(
      std::count_if(values.begin(), values.end(), [&](double v) { return v > threshold; }));
}

std::size_t count_mistracked(const Trace& trace, const PeakThresholds& peaks) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < trace.region.size(); ++i) {
    count += trace.region[i] > peaks.region || trace.contour[i] > peaks.contour ? 1 : 0;
  }
  return count;
}

Trace track_sequence(const PreparedSequence& sequence, const RegistrationConfig& config, std::uint64_t seed,
                     const std::string& backend) {
  const auto evaluator = make_backend(backend);
  Random random(seed);
  Recorder recorder(sequence);
  Pose pose = sequence.start;
  for (std::size_t t = sequence.first; t < sequence.frames.size(); ++t) {
    Objective objective(*evaluator, sequence.frames[t], sequence.model, sequence.limits,
                        prior_at(sequence.model.body, pose));
    const RegistrationResult found = register_pose(objective, pose, config, random);
    pose = found.pose;
    recorder.add(t, pose, found.score, found.region_evaluations + found.edge_evaluations);
  }
  return recorder.trace();
}

FilterSetup reference_setup(const std::string& heuristics) {
  return {.filter = reference_filter(heuristics), .search = reference_registration(), .velocity = 0.0};
}

FilterSetup our_setup() {
  const Config config;
  return {.filter = config.filter, .search = config.registration, .velocity = config.tracking.velocity};
}

Trace track_filter(const PreparedSequence& sequence, const FilterSetup& setup, std::uint64_t seed) {
  Evaluators evaluators("simd", 1, setup.cues);
  const ParticleFilter filter(setup.filter, setup.search, sequence.limits, evaluators);
  FilterState state(seed);
  Recorder recorder(sequence);
  std::vector<double> effective;
  std::vector<double> moving;
  start_filter(sequence.start, sequence.limits, state);
  for (std::size_t t = sequence.first; t < sequence.frames.size(); ++t) {
    const FilterResult found = filter.step(
        {.frame = sequence.frames[t], .model = sequence.model, .velocity = setup.velocity}, state);
    recorder.add(t, found.pose, found.score, found.evaluations);
    effective.push_back(found.effective_particles);
    moving.push_back(static_cast<double>(found.moving.count()) / static_cast<double>(found.moving.size()));
  }
  Trace trace = recorder.trace();
  trace.effective = std::move(effective);
  trace.moving = std::move(moving);
  return trace;
}

RegistrationConfig reference_with(int region, int edge) {
  RegistrationConfig config = reference_registration();
  const int both = region + edge;
  config.iterations = both + 1;  // the last one scores the pose that is returned
  config.region_share = both > 0 ? static_cast<double>(region) / both : 1.0;
  return config;
}

}  // namespace telemime
