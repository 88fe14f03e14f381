// SPDX-License-Identifier: Apache-2.0
#include "telemime/offline/look_ahead.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "telemime/core/in_parallel.h"
#include "telemime/likelihood/all.h"
#include "telemime/offline/record_queue.h"

namespace telemime {
namespace {

// Neighbouring frames look alike: one in this time is enough to pick from.
constexpr double kStride = 3.0;    // 1/25 s
constexpr double kExactly = 0.01;  // 1/25 s, of sums of time
constexpr double kSlack = 0.5;     // 1/25 s, of sums of time
// Fewer keyframes than this tell no more than the first frame alone.
constexpr std::size_t kFewest = 3;

// A frame that the shape may be fitted to, with the head that it shows.
struct Candidate {
  Keyframe keyframe;
  std::int64_t frame = 0;
  HeadRegion head;
};

// The frames that fit best, apart from each other; where there are faces, among those with one. A mask hides
// it in all of them.
std::vector<std::size_t> best_portraits(const std::vector<Candidate>& candidates) {
  constexpr std::size_t kMost = 3;
  constexpr std::size_t kApart = 5;
  const bool faces =
      std::any_of(candidates.begin(), candidates.end(), [](const Candidate& c) { return c.head.detected; });
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (candidates[i].head.detected || !faces) {
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

// A person as one frame shows them, with the poses of all candidates for that shape. The first candidate is
// the frame where tracking starts.
struct Portrait {
  KnownStart start;
  std::vector<Candidate> candidates;
};

Portrait portrait_of(const Config& config, Backend& backend, const JointLimits& limits, const Portrait& from,
                     const Calibration& fit, std::size_t where, Random& random) {
  Portrait portrait = from;
  KnownStart& start = portrait.start;
  start.person.shape = fit.shape;
  start.person.score = fit.score;
  start.person.refusal = fit.refusal;
  start.pose = fit.pose;
  start.frame = from.candidates[where].frame;
  const Model model = make_model(fit.shape);
  for (Candidate& candidate : portrait.candidates) {
    Objective objective(backend, candidate.keyframe.frame, model, limits);
    candidate.keyframe.pose =
        initialise_pose(objective, candidate.head, config.calibration, config.registration, random);
    candidate.keyframe.region = objective.score(candidate.keyframe.pose, Reduction::overlap).region();
  }
  std::swap(portrait.candidates.front(), portrait.candidates[where]);
  portrait.candidates.front().keyframe.pose = fit.pose;
  return portrait;
}

// The most different of the candidates, and the first, whose pose is needed for every shape; empty when there
// are too few.
std::vector<Keyframe> keyframes_of(const Config& config, const Portrait& portrait) {
  std::vector<Keyframe> all;
  all.reserve(portrait.candidates.size());
  for (const Candidate& candidate : portrait.candidates) {
    all.push_back(candidate.keyframe);
  }
  const auto count = static_cast<std::size_t>(config.calibration.refine.keyframes);
  const std::vector<std::size_t> picked = pick_keyframes(make_body(portrait.start.person.shape), all, count);
  std::vector<Keyframe> keyframes;
  if (picked.size() >= kFewest) {
    keyframes.push_back(all.front());
    for (const std::size_t i : picked) {
      keyframes.push_back(all[i]);
    }
  }
  return keyframes;
}

// The shape fitted to all keyframes in this many rounds; 0 only tells what it costs.
ShapeRefinement refined(const Config& config, const std::string& backend, const JointLimits& limits,
                        const Portrait& portrait, const std::vector<Keyframe>& keyframes, int rounds) {
  ShapeRefineConfig refine = config.calibration.refine;
  refine.rounds = rounds;
  ShapeRefinement found;
  on_threads(config.threads, [&] {
    found = refine_shape([&] { return make_backend(backend, {.cues = config.cues}); }, keyframes,
                         portrait.start.person.shape, limits, config.calibration.shape, refine);
  });
  return found;
}

// How badly the person explains the keyframes before the shape is fitted to them; nothing without keyframes.
std::optional<double> cost_of(const Config& config, const std::string& backend, const JointLimits& limits,
                              const Portrait& portrait) {
  const std::vector<Keyframe> keyframes = keyframes_of(config, portrait);
  if (keyframes.empty()) {
    return std::nullopt;
  }
  return refined(config, backend, limits, portrait, keyframes, 0).cost;
}

// Somebody who walks in is first seen from the side: where later frames fit much better, or explain the
// others much better, the person is fitted there, and all poses are looked for again. One such frame may
// still hide where a sleeve ends or how far away the arms are: all of them are tried. Else what the first
// frame gave.
std::vector<Portrait> portraits_of(const Config& config, const std::string& backend_name,
                                   const JointLimits& limits, Portrait first) {
  constexpr double kMuchBetter = 0.8;    // F of the frame that the person was fitted in
  constexpr double kExplainsMore = 0.9;  // cost of the keyframes
  const auto backend = make_backend(backend_name, {.cues = config.cues});
  Random random(config.seed);
  std::vector<std::pair<std::size_t, Calibration>> fits;
  bool better = false;
  for (const std::size_t i : best_portraits(first.candidates)) {
    fits.emplace_back(i, calibrate(*backend, first.candidates[i].keyframe.frame, first.candidates[i].head,
                                   limits, config.calibration, config.registration, random));
    better = better || fits.back().second.score.region() <= kMuchBetter * first.start.person.score.region();
  }
  const std::optional<double> usual = better ? std::nullopt : cost_of(config, backend_name, limits, first);
  std::vector<Portrait> portraits;
  for (const auto& [where, fit] : fits) {
    if (better ? fit.score.region() >= first.start.person.score.region() : !usual.has_value()) {
      continue;
    }
    Portrait portrait = portrait_of(config, *backend, limits, first, fit, where, random);
    const std::optional<double> cost = usual ? cost_of(config, backend_name, limits, portrait) : std::nullopt;
    if (better || (cost && *cost < kExplainsMore * *usual)) {
      portraits.push_back(std::move(portrait));
    }
  }
  if (portraits.empty()) {
    portraits.push_back(std::move(first));
  }
  return portraits;
}

// The frame in which somebody is first tracked, and the tracked frames from there on.
struct Scouting {
  Portrait first;
  std::int64_t tracked = 0;     // frames
  double tracked_for = 0.0;     // 1/25 s
  double next_candidate = 0.0;  // 1/25 s of tracked_for

  bool done(double look_ahead) const { return tracked_for > look_ahead - kSlack; }

  void add(const FrameRecord& record, const TrackingRun& run) {
    if (!run.state.person) {
      return;
    }
    const MotionFrame& motion = record.estimate.motion;
    if (first.candidates.empty()) {
      first.start = {.person = *run.state.person,
                     .frame = motion.frame,
                     .pose = motion.pose,
                     .visible_since = run.scene.head_since};
    }
    if (!is_tracked(record) || !record.estimate.prepared) {
      return;
    }
    const bool due = tracked_for > next_candidate - kExactly;
    if (due && record.features.head) {
      first.candidates.push_back({.keyframe = {*record.estimate.prepared, motion.pose, motion.region_score},
                                  .frame = motion.frame,
                                  .head = *record.features.head});
    }
    next_candidate = due ? tracked_for + kStride : next_candidate;
    tracked_for += run.state.elapsed;
    ++tracked;
  }
};

// The best of the shapes that the portraits lead to.
FittedPerson fit_person(const Tracker& tracker, Scouting scouting) {
  // Single poses on many threads suit no device.
  const std::string backend = tracker.config.backend == "scalar" ? "scalar" : "simd";
  const std::vector<Portrait> portraits =
      portraits_of(tracker.config, backend, tracker.limits, std::move(scouting.first));
  FittedPerson best;
  best.start = portraits.front().start;
  best.frames = scouting.tracked;
  for (const Portrait& portrait : portraits) {
    const std::vector<Keyframe> keyframes = keyframes_of(tracker.config, portrait);
    if (keyframes.empty()) {
      continue;
    }
    const ShapeRefinement fit = refined(tracker.config, backend, tracker.limits, portrait, keyframes,
                                        tracker.config.calibration.refine.rounds);
    if (best.keyframes == 0 || fit.cost < best.cost) {
      best.start = portrait.start;
      best.start.person.refusal.clear();  // whatever the first frame hid, the keyframes show
      best.start.person.shape = fit.shape;
      best.start.pose = fit.poses.front();
      best.keyframes = keyframes.size() - 1;
      best.cost_before = fit.cost_before;
      best.cost = fit.cost;
    }
  }
  return best;
}

}  // namespace

LookAhead look_ahead(const LookAheadCalls& calls, TrackingRun& run) {
  LookAhead result;
  Scouting scouting;
  // Snapshot of the state before the first record that is kept: where tracking starts again.
  TrackerState before = run.state;
  while (!scouting.done(run.tracker.config.calibration.look_ahead) && result.records.size() < kMostWaiting) {
    const std::optional<Frame> frame = calls.next();
    if (!frame) {
      break;
    }
    // The image side of the frame. A person who has just come into the picture may be found from here on.
    FrameRecord record{.frame = *frame, .features = {}, .estimate = {}};
    record.features = extract(*frame, colour_request(run.state), run.scene);
    keep_picture(calls.longest_side, record.frame);
    if (scouting.first.candidates.empty() && run.scene.head_since >= frame->index) {
      for (FrameRecord& earlier : result.records) {
        if (calls.settle) {
          calls.settle(std::move(earlier));
        }
      }
      result.records.clear();
      before = run.state;
    }
    // The search side. How badly labels fit an unfitted shape says nothing about the labels.
    run.state.region_residual.reset();
    record.estimate = estimate(record.features, run.tracker, run.state);
    scouting.add(record, run);
    result.records.push_back(std::move(record));
    if (calls.go_on && !calls.go_on(result.records.back())) {
      return result;
    }
  }
  if (scouting.first.candidates.empty()) {
    return result;
  }
  // The person's shape, and all frames from where they came into the picture once more with it.
  result.person = fit_person(run.tracker, std::move(scouting));
  // As all of these frames show them. Files have hands of one size, which is then the same from the first
  // frame.
  before.neutral_face = run.state.neutral_face;
  before.hands.sizes = run.state.hands.sizes;
  before.hands.frames = run.state.hands.frames;
  if (before.hands.sizes) {
    before.hands.sizes->palm *=
        result.person->start.person.shape.stature / run.state.model.body.shape.stature;
  }
  run.state = std::move(before);
  run.state.known_start = result.person->start;
  for (FrameRecord& record : result.records) {
    record.estimate = estimate(record.features, run.tracker, run.state);
  }
  return result;
}

}  // namespace telemime
