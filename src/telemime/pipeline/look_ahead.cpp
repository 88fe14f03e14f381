// SPDX-License-Identifier: Apache-2.0
#include "telemime/pipeline/look_ahead.h"

#include <vector>

#include "telemime/likelihood/all.h"

namespace telemime {
namespace {

// Neighbouring frames look alike: every third one is enough to pick from.
constexpr std::int64_t kStride = 3;
// Fewer keyframes than this tell no more than the first frame alone.
constexpr std::size_t kFewest = 3;

}  // namespace

std::optional<LookAhead> look_ahead(Source& source, const Config& config, const Camera& camera,
                                    const ImageCalibration& scene, std::int64_t most_frames,
                                    const std::function<bool(std::int64_t)>& go_on) {
  Tracker scout(config, camera);
  scout.set_scene(scene);
  std::vector<Keyframe> candidates;
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
    if (seen.motion.state == TrackState::tracking && found.frames++ % kStride == 0) {
      candidates.push_back(
          {prepare(seen.observation, scout.working_camera()), seen.motion.pose, seen.motion.region_score});
    }
  }
  if (candidates.empty()) {
    return std::nullopt;
  }
  found.image = scout.features().calibration();
  const auto count = static_cast<std::size_t>(config.calibration.refine.keyframes);
  std::vector<Keyframe> keyframes;
  for (const std::size_t i : pick_keyframes(scout.model().body, candidates, count)) {
    keyframes.push_back(candidates[i]);
  }
  if (keyframes.size() < kFewest) {
    return found;
  }
  found.keyframes = keyframes.size();
  found.start.person.refusal.clear();  // whatever the first frame hid, these show
  // The pose in the first frame is needed for the new shape, too.
  keyframes.insert(keyframes.begin(), candidates.front());
  // Single poses on many threads suit no device.
  const bool own = config.backend == "scalar" || config.backend == "parts";
  const std::string backend = own ? config.backend : "simd";
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
