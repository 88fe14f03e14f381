// SPDX-License-Identifier: Apache-2.0
// The contribution of each part of the whole program, measured by leaving it out: body, cues, prior, time,
// and what networks add in a room whose background nobody knows.
#include <array>
#include <functional>
#include <limits>
#include <span>
#include <sstream>

#include "lab/experiments/experiments.h"
#include "lab/synth/actor.h"
#include "telemime/core/scratch_folder.h"
#include "telemime/evaluation/evaluate.h"
#include "telemime/offline/track_file.h"
#include "telemime/outputs/readers/jsonl.h"

namespace telemime {
namespace {

namespace fs = std::filesystem;

struct Lever {
  const char* group;
  const char* name;
  void (*change)(Config&);
};

void each_weights(Config& c, const std::function<void(ObjectiveWeights&)>& change) {
  change(c.registration.region);
  change(c.registration.edge);
}

void without_pose_prior(Config& c) {
  c.filter.natural = c.calibration.refine.natural_weight = 0.0;
  each_weights(c, [](ObjectiveWeights& w) { w.natural = 0.0; });
}

// Removes one name from a list with commas.
void leave_out(std::string_view name, std::string& list) {
  std::string rest;
  std::stringstream names(list);
  for (std::string each; std::getline(names, each, ',');) {
    if (each != name) {
      rest.append(rest.empty() ? "" : ",").append(each);
    }
  }
  list = rest;
}

const std::array<Lever, 15> kLevers = {{
    {"", "unchanged", [](Config&) {}},
    {"body", "fitted to one frame, not to many", [](Config& c) { c.calibration.look_ahead = 0; }},
    {"body", "bones of average proportions",
     [](Config& c) { c.calibration.shape.length_spread = c.calibration.shape.ratio_spread = 1e-3; }},
    {"body", "average girths", [](Config& c) { c.calibration.shape.girth_spread = 1e-3; }},
    {"image", "160x120 instead of 320x240",
     [](Config& c) {
       c.image.width = 160;
       c.image.height = 120;
     }},
    {"image", "640x480 instead of 320x240",
     [](Config& c) {
       c.image.width = 640;
       c.image.height = 480;
     }},
    {"image", "no contours in the search",
     [](Config& c) { each_weights(c, [](ObjectiveWeights& w) { w.cues[cue::kContour] = 0.0; }); }},
    {"prior", "segments may intersect",
     [](Config& c) {
       c.filter.invalid = 0.0;
       each_weights(c, [](ObjectiveWeights& w) { w.invalid = 0.0; });
     }},
    {"prior", "no pose prior", without_pose_prior},
    {"time", "no pull toward the predicted pose",
     [](Config& c) {
       c.filter.temporal = 0.0;
       each_weights(c, [](ObjectiveWeights& w) { w.temporal = w.trunk = 0.0; });
     }},
    {"time", "no predicted arm motion", [](Config& c) { c.tracking.velocity = 0.0; }},
    {"time", "no smoothing", [](Config& c) { c.smoothing.name = "none"; }},
    {"time", "smoothed forward only, as live", [](Config& c) { c.smoothing.look_ahead = 0; }},
    {"time", "with --offline", [](Config& c) { c.look_back = true; }},
    {"search", "one pose, no particles (two-step)", [](Config& c) { c.tracking.method = "two-step"; }},
}};

const std::array<Lever, 11> kLearned = {{
    {"", "unchanged", [](Config&) {}},
    {"networks", "none", [](Config& c) { c.cue_names = "regions,contours"; }},
    {"cue", "no landmarks", [](Config& c) { c.cue_names = "regions,contours,bones"; }},
    {"cue", "no directions of bones in depth", [](Config& c) { c.cue_names = "regions,contours,landmarks"; }},
    {"cue", "no regions", [](Config& c) { c.cue_names = "contours,landmarks,bones"; }},
    {"cue", "no contours", [](Config& c) { c.cue_names = "regions,landmarks,bones"; }},
    {"image", "no mask of the person", [](Config& c) { c.image.mask_trust = 0.0; }},
    {"search", "no poses from landmarks", [](Config& c) { leave_out("landmarks", c.filter.heuristics); }},
    {"search", "no exchange of arms", [](Config& c) { leave_out("arms", c.filter.heuristics); }},
    {"prior", "no pose prior", without_pose_prior},
    {"time", "forward only", [](Config& c) { c.look_back = false; }},
}};

struct Clip {
  fs::path folder;
  bool background = true;  ///< whether the video of the empty scene is used
};

struct Measured {
  double aligned = 0.0;  // mm
  double depth = 0.0;    // mm
  double pixels = 0.0;
  double jitter = 0.0;  // over the truth's own
  double lost = 0.0;    // share of the frames
};

Measured run_once(const Lab& lab, const Clip& clip, const Config& config, const Lever& lever,
                  std::uint64_t seed) {
  const ScratchFolder scratch;
  TrackRequest request;
  const fs::path& folder = clip.folder;
  request.input = find_video(folder, "video").value_or(folder / "clip.mp4").string();
  if (clip.background) {
    request.background = find_video(folder, "background").value_or("").string();
  }
  if (fs::exists(folder / "camera.yml")) {
    request.camera = (folder / "camera.yml").string();
  }
  request.out = scratch.path();
  request.formats = {"jsonl"};
  request.overlay = false;
  request.config = config;
  request.config.seed = seed;
  request.config.face = request.config.hands = false;  // they do not change the body
  if (lab.options().quick) {
    constexpr int kFew = 12;
    request.most_frames = kFew;
    request.config.calibration.look_ahead = kFew;
    request.config.image.width = 160;
    request.config.image.height = 120;
    request.config.filter.particles = request.config.registration.iterations = 100;
  }
  lever.change(request.config);
  track_file(request, {});
  const PoseFile pose = read_pose_jsonl(scratch.path() / "pose.jsonl");
  const Evaluation e = evaluate(pose.frames, pose.camera, read_truth(folder / "truth.json"), {});
  constexpr double kMillimetres = 1000.0;
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();  // nothing was tracked
  const MeanErrors& errors = e.tracked.scored;
  return {kMillimetres * errors.aligned.value_or(kNone), kMillimetres * errors.depth.value_or(kNone),
          errors.pixels.value_or(kNone),
          e.jitter && e.truth_jitter.value_or(0.0) > 0.0 ? *e.jitter / *e.truth_jitter : kNone,
          e.lost_scored};
}

// The four gestures, and other clips beside their folder that have a truth.
std::vector<Clip> clips_of(const Lab& lab, bool background, std::initializer_list<const char*> others) {
  std::vector<Clip> clips;
  for (const std::string_view name : kThesisGestures) {
    clips.push_back({lab.options().data / name, background});
  }
  for (const char* other : others) {
    const fs::path folder = (lab.options().data / ".." / other).lexically_normal();
    if (!lab.options().quick && fs::exists(folder / "truth.json")) {
      clips.push_back({folder, background});
    }
  }
  return clips;
}

// Tracks the clips once as they are and once with each lever.
Finding change_one(Lab& lab, std::span<const Lever> levers, const std::vector<Clip>& clips,
                   const Config& config, const std::string& conditions) {
  Table table{"the whole program, one part changed",
              {"part", "changed", "3-D error (mm)", "change of it (mm)", "depth error (mm)", "2-D error (px)",
               "jitter / truth's", "lost frames (%)"},
              {}};
  Table by_clip{"3-D error (mm) by clip", {"changed"}, {}};
  for (const Clip& clip : clips) {
    by_clip.columns.push_back(clip.folder.filename().string());
  }
  double base = 0.0;
  std::string changes;
  for (const Lever& lever : levers) {
    lab.log("the whole program: " + std::string(lever.name));
    Sweep<Measured> sweep{{0}, clips.size(), lab.seeds(), {}};
    by_clip.rows.push_back({lever.name});
    for (const Clip& clip : clips) {
      for (std::size_t s = 0; s < lab.seeds(); ++s) {
        sweep.runs.push_back(run_once(lab, clip, config, lever, lab.options().seed + s));
      }
      by_clip.rows.back().push_back(
          mean_and_range(sweep.at(by_clip.rows.back().size() - 1, 0, &Measured::aligned)));
    }
    const Spread error = sweep.over_sequences(0, &Measured::aligned);
    base = table.rows.empty() ? error.mean : base;
    constexpr double kPercent = 100.0;
    table.rows.push_back({lever.group, lever.name, mean_and_range(error),
                          table.rows.empty() ? "" : number(error.mean - base),
                          mean_and_range(sweep.over_sequences(0, &Measured::depth)),
                          mean_and_range(sweep.over_sequences(0, &Measured::pixels)),
                          number(sweep.over_sequences(0, &Measured::jitter).mean),
                          number(kPercent * sweep.over_sequences(0, &Measured::lost).mean)});
    if (table.rows.size() > 1) {
      changes.append(changes.empty() ? "" : "; ").append(lever.name).append(error.mean < base ? " " : " +");
      changes.append(number(error.mean - base));
    }
  }
  return {.tables = {table, by_clip},
          .notes = {"`telemime track` on each clip " + conditions +
                    ", default settings except for one part; elbows and wrists, mid-shoulders aligned. Means "
                    "over the clips; in brackets the lowest and highest of the " +
                    std::to_string(lab.seeds()) +
                    " seeds. A useful part has a positive change when it is left out."},
          .verdict =
              "no figure of the thesis. Unchanged " + number(base) + " mm; change in mm: " + changes + "."};
}

}  // namespace

Finding levers(Lab& lab) {
  Config config;
  config.look_back = false;
  return change_one(lab, kLevers, clips_of(lab, true, {"dev_practical/desk_talk"}), config,
                    "with its background, forward only");
}

Finding learned_parts(Lab& lab) {
  return change_one(lab, kLearned, clips_of(lab, false, {"real/seated_stereo", "real/pose2sim_cam2"}), {},
                    "in the room as it is, without a background");
}

}  // namespace telemime
