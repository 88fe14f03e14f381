// SPDX-License-Identifier: Apache-2.0
#include "telemime/pipeline/look_ahead.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "telemime/likelihood/all.h"

namespace telemime {
namespace {

// Neighbouring frames look alike: every third one is enough to pick from.
constexpr std::int64_t kStride = 3;
// Fewer keyframes than this tell no more than the first frame alone.
constexpr std::size_t kFewest = 3;

// A frame that the shape may be fitted to, with the head that it shows.
struct Candidate {
  Keyframe keyframe;
  std::int64_t frame = 0;
  HeadRegion head;
};

// The frames that fit best among those with a face, apart from each other.
std::vector<std::size_t> best_portraits(const std::vector<Candidate>& candidates) {
  constexpr std::size_t kMost = 3;
  constexpr std::size_t kApart = 5;
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (candidates[i].head.detected) {
      order.push_back(i);
    }
  }
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return candidates[a].keyframe.region < candidates[b].keyframe.region;
  });
  std::vector<std::size_t> best;
  for (const std::size_t i : order) {
    if (best.size() < kMost && std::all_of(best.begin(), best.end(), [&](std::size_t b) {
          return std::max(i, b) - std::min(i, b) >= kApart;
        })) {
      best.push_back(i);
    }
  }
  return best;
}

// Somebody who walks in is first seen from the side: where a later frame fits much better, the person is
// fitted there, and all poses are looked for again.
void fit_again(const Config& config, const std::string& backend_name, const JointLimits& limits,
               std::vector<Candidate>& candidates, KnownStart& start) {
  constexpr double kMuchBetter = 0.8;
  const auto backend = make_backend(backend_name);
  Random random(config.seed);
  std::optional<Calibration> best;
  std::size_t where = 0;
  for (const std::size_t i : best_portraits(candidates)) {
    const Calibration fit = calibrate(*backend, candidates[i].keyframe.frame, candidates[i].head, limits,
                                      config.calibration, config.registration, random);
    if (!best || fit.score.region < best->score.region) {
      best = fit;
      where = i;
    }
  }
  if (!best || best->score.region > kMuchBetter * start.person.score.region) {
    return;
  }
  start.person.shape = best->shape;
  start.person.score = best->score;
  start.person.refusal = best->refusal;
  start.pose = best->pose;
  start.frame = candidates[where].frame;
  const Model model = make_model(best->shape);
  for (Candidate& candidate : candidates) {
    Objective objective(*backend, candidate.keyframe.frame, model, limits);
    candidate.keyframe.pose =
        initialise_pose(objective, candidate.head, config.calibration, config.registration, random);
    candidate.keyframe.region = objective.score(candidate.keyframe.pose, Reduction::overlap).region;
  }
  // The first candidate is the frame where tracking starts.
  std::swap(candidates.front(), candidates[where]);
  candidates.front().keyframe.pose = best->pose;
}

}  // namespace

std::optional<LookAhead> look_ahead(Source& source, const Config& config, const Camera& camera,
                                    const ImageCalibration& scene, std::int64_t most_frames,
                                    const std::function<bool(std::int64_t)>& go_on) {
  Config forward = config;
  forward.look_back = false;
  Tracker scout(forward, camera);
  scout.set_scene(scene);
  std::vector<Candidate> candidates;
  LookAhead found;
  for (std::int64_t i = 0; most_frames == 0 || i < most_frames; ++i) {
    const std::optional<Frame> frame = source.next();
    if (!frame || found.frames >= config.calibration.look_ahead) {
      break;
    }
    const TrackedFrame seen = scout.step(*frame);
    if (!go_on(i)) {
      return std::nullopt;
    }
    if (!scout.calibration()) {
      continue;
    }
    if (candidates.empty()) {
      found.start = {*scout.calibration(), seen.motion.frame, seen.motion.pose, scout.since()};
    }
    if (seen.motion.state == TrackState::tracking && found.frames++ % kStride == 0 && seen.observation.head) {
      candidates.push_back(
          {{prepare(seen.observation, scout.working_camera()), seen.motion.pose, seen.motion.region_score},
           seen.motion.frame,
           *seen.observation.head});
    }
  }
  if (candidates.empty()) {
    return std::nullopt;
  }
  found.image = scout.features().calibration();
  // Single poses on many threads suit no device.
  const bool own = config.backend == "scalar" || config.backend == "parts";
  const std::string backend = own ? config.backend : "simd";
  fit_again(config, backend, scout.limits(), candidates, found.start);
  std::vector<Keyframe> all;
  all.reserve(candidates.size());
  for (const Candidate& candidate : candidates) {
    all.push_back(candidate.keyframe);
  }
  const auto count = static_cast<std::size_t>(config.calibration.refine.keyframes);
  std::vector<Keyframe> keyframes;
  const Body body = make_body(found.start.person.shape);
  for (const std::size_t i : pick_keyframes(body, all, count)) {
    keyframes.push_back(all[i]);
  }
  if (keyframes.size() < kFewest) {
    return found;
  }
  found.keyframes = keyframes.size();
  found.start.person.refusal.clear();  // whatever the first frame hid, these show
  // The pose in the first frame is needed for the new shape, too.
  keyframes.insert(keyframes.begin(), all.front());
  const ShapeRefinement refined =
      refine_shape([&backend] { return make_backend(backend); }, keyframes, found.start.person.shape,
                   scout.limits(), config.calibration.shape, config.calibration.refine);
  found.start.person.shape = refined.shape;
  found.start.pose = refined.poses.front();
  found.cost_before = refined.cost_before;
  found.cost = refined.cost;
  return found;
}

}  // namespace telemime
