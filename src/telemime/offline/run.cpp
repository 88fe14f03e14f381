// SPDX-License-Identifier: Apache-2.0
#include "telemime/offline/run.h"

#include <algorithm>
#include <chrono>
#include <deque>
#include <utility>

#include "telemime/core/errors.h"
#include "telemime/offline/gap_filler.h"
#include "telemime/offline/look_ahead.h"
#include "telemime/offline/offline.h"
#include "telemime/offline/overlay.h"
#include "telemime/offline/put_away.h"
#include "telemime/offline/run_outputs.h"
#include "telemime/offline/run_statistics.h"
#include "telemime/offline/two_way_smoother.h"
#include "telemime/tracker/person_file.h"
#include "telemime/tracker/scene.h"
#include "telemime/tracker/set_up.h"
#include "telemime/tracker/told.h"

namespace telemime {
namespace {

using Clock = std::chrono::steady_clock;

// A tracked frame until it is smoothed and can be written.
struct Waiting {
  Frame frame;
  std::string note;
};

// One run: what is written waits until the person's shape is known, because every file begins with it.
class Run {
 public:
  Run(const TrackRequest& request, const RunHooks& hooks, const SourceInfo& info, Tracker& tracker)
      : request_(request), hooks_(hooks), info_(info), tracker_(tracker), outputs_(request, info.fps) {
    if (tracker.config().look_back) {
      offline_ = std::make_unique<OfflineTracker>(tracker.config(), tracker.limits());
    }
    const TrackingConfig& tracking = tracker.config().tracking;
    if (!info.live && tracking.fill_back > 0 && uses_filter(tracker.config())) {
      gaps_ = std::make_unique<GapFiller>(tracker);
    }
  }

  Wish step(const Frame& frame) {
    tracker_.look(frame, tracker_.settled(), seen_);
    TrackedFrame result = tracker_.decide(seen_);
    tell(result.note);
    for (const std::string& warning : result.warnings) {
      tell(warning);
    }
    if (tracker_.calibration() && !outputs_.begun()) {
      begin();
    }
    ++frames_;
    OfflineFrame decided{frame, result.note, result.motion, std::move(result.stretch), {}};
    if (!request_.overlay && !hooks_.draw) {
      decided.frame.image.release();  // of many frames they take much memory
    }
    std::optional<PreparedFrame> unsolved;
    if (gaps_ && result.motion.state == TrackState::lost && seen_.coloured && seen_.person) {
      unsolved = std::exchange(seen_.prepared, {});
    }
    if ((offline_ && smoother_) || unsolved) {
      put_away(decided);
    }
    if (gaps_) {
      const std::size_t filled = gaps_->push({std::move(decided), std::move(unsolved)});
      tell(filled == 0 ? ""
                       : "found, and followed back through the " + std::to_string(filled) + " frames before");
      take_filled();
    } else {
      look_back(std::move(decided));
    }
    if (!hooks_.progress) {
      return Wish::go_on;
    }
    const double seconds = std::chrono::duration<double>(Clock::now() - start_).count();
    return hooks_.progress({frames_, info_.frames, seconds, &result, overlay_.empty() ? nullptr : &overlay_});
  }

  // What waits belongs to the person that is followed now.
  void finish_person() {
    if (gaps_) {
      gaps_->finish();
      take_filled();
    }
    if (offline_) {
      offline_->finish();
      take_decided();
    }
  }

  TrackSummary finish(bool interrupted, const std::string& complaint, const nlohmann::json& scene) {
    if (!outputs_.begun()) {
      begin();
    }
    if (interrupted && offline_) {
      offline_->give_up();  // who stops a run does not want to wait for it
    }
    finish_person();
    smoother_->finish();
    write_ready();
    TrackSummary summary;
    summary.frames = statistics_.frames;
    summary.tracked = statistics_.tracked;
    summary.first_tracked = statistics_.first_tracked;
    summary.seconds = std::chrono::duration<double>(Clock::now() - start_).count();
    summary.interrupted = interrupted;
    summary.report = statistics_.json();
    summary.report["input"] = info_.name;
    summary.report["fps"] = info_.fps;
    summary.report["seconds"] = summary.seconds;
    summary.report["interrupted"] = interrupted;
    summary.report["scene"] = scene;
    summary.report["notes"] = notes_;
    if (!complaint.empty()) {
      summary.report["complaint"] = complaint;
    }
    if (tracker_.calibration()) {
      summary.report["scale_from"] = tracker_.calibration()->scale_from;
      summary.report["calibration_refusal"] = tracker_.calibration()->refusal;
    }
    summary.report["files"] = outputs_.files();
    outputs_.close(summary.report);
    return summary;
  }

 private:
  void take_filled() {
    while (auto frame = gaps_->next()) {
      look_back(std::move(*frame));
    }
  }

  void look_back(OfflineFrame frame) {
    if (offline_ && smoother_) {
      offline_->push(std::move(frame));
      take_decided();
    } else {
      accept(std::move(frame));
    }
  }

  void take_decided() {
    while (auto decided = offline_->next(tracker_.model(), tracker_.camera())) {
      accept(std::move(*decided));
    }
  }

  void accept(OfflineFrame frame) {
    take_out(frame);
    const MotionFrame& motion = frame.motion;
    const Waiting waiting{frame.frame, frame.note};
    statistics_.add(motion);
    if (smoother_) {
      waiting_.push_back(waiting);
      smoother_->push(motion);
      write_ready();
    } else {
      // Nobody was found yet, maybe for a long time: the pictures are not kept.
      draw(waiting, motion);
      before_.push_back(motion);
    }
  }

  void begin() {
    const StreamHeader header = header_of(info_, tracker_);
    outputs_.begin(header);
    SmoothingOptions smoothing = request_.config.smoothing;
    if (info_.live) {
      smoothing.look_ahead = 0;
    }
    smoother_ = std::make_unique<TwoWaySmoother>(smoothing, header.body, header.camera);
    for (const MotionFrame& motion : before_) {
      outputs_.write(motion);
    }
    before_.clear();
  }

  void draw(const Waiting& waiting, const MotionFrame& motion) {
    if (request_.overlay || hooks_.draw) {
      overlay_ =
          draw_overlay(waiting.frame.image, {&motion, &tracker_.model(), tracker_.camera(), waiting.note});
      if (request_.overlay) {
        outputs_.write_overlay(overlay_);
      }
    }
  }

  void write_ready() {
    while (const auto motion = smoother_->next()) {
      outputs_.write(*motion);
      draw(waiting_.front(), *motion);
      waiting_.pop_front();
    }
  }

  // Each reason once, whatever its numbers, with the frame at which it came up first.
  void tell(const std::string& note) {
    if (note.empty() || !told_.is_new(note)) {
      return;
    }
    notes_.push_back({{"frame", frames_}, {"note", note}});
    if (hooks_.message) {
      hooks_.message("frame " + std::to_string(frames_) + ": " + note);
    }
  }

  const TrackRequest& request_;
  const RunHooks& hooks_;
  const SourceInfo& info_;
  Tracker& tracker_;
  Clock::time_point start_ = Clock::now();
  RunOutputs outputs_;
  std::unique_ptr<TwoWaySmoother> smoother_;
  std::int64_t frames_ = 0;  // read so far; offline, fewer are decided
  RunStatistics statistics_;
  SeenFrame seen_;  // for its memory
  std::unique_ptr<GapFiller> gaps_;
  std::unique_ptr<OfflineTracker> offline_;
  std::vector<MotionFrame> before_;  // all lost: until the person's shape is known
  std::deque<Waiting> waiting_;
  cv::Mat overlay_;  // the last one drawn
  Told told_;
  nlohmann::json notes_ = nlohmann::json::array();
};

// The tracker of an input, with what the scene or a calibration file teaches it.
struct Prepared {
  std::unique_ptr<Source> source;
  std::unique_ptr<Tracker> tracker;
  Footage scene;
};

// Files can be read twice: the person's shape is fitted to many frames before the first one is written.
std::optional<LookAhead> look_ahead_of(const TrackRequest& request, const RunHooks& hooks,
                                       const Prepared& p) {
  if (p.source->info().live || !request.calibration.empty() || request.config.calibration.look_ahead == 0) {
    return std::nullopt;
  }
  const auto again = open_source(request.input);
  const auto go_on = [&](std::int64_t frame) {
    return !hooks.progress || hooks.progress({frame + 1, 0, 0.0, nullptr, nullptr}) != Wish::stop;
  };
  auto found = look_ahead(*again, p.tracker->config(), p.tracker->camera(),
                          p.tracker->features().calibration(), request.most_frames, go_on);
  if (found && hooks.message) {
    hooks.message(found->keyframes > 0 ? "the body was fitted to " + std::to_string(found->keyframes) +
                                             " of the first " + std::to_string(found->frames) + " frames"
                                       : "the body was fitted to one frame: too few others show both arms");
  }
  return found;
}

Prepared prepare_run(const TrackRequest& request, const RunHooks& hooks) {
  Prepared p;
  p.source = open_source(request.input);
  const SourceInfo& info = p.source->info();
  if (info.live && request.config.look_back) {
    throw Error(ErrorKind::usage, "--offline needs a file: " + info.name + " has no end to look back from",
                "Leave --offline out, or record the camera first.");
  }
  std::vector<std::string> messages;
  p.tracker = make_tracker(request, info, messages);
  if (request.calibration.empty()) {
    p.scene = learn_scene(request, info, *p.source, *p.tracker);
  }
  p.scene.messages.insert(p.scene.messages.begin(), messages.begin(), messages.end());
  if (hooks.message) {
    for (const std::string& words : p.scene.messages) {
      hooks.message(words);
    }
  }
  return p;
}

}  // namespace

TrackerCalibration run_calibrate(const TrackRequest& request, const RunHooks& hooks,
                                 const std::filesystem::path& file) {
  prepare_file(file);
  TrackRequest forward = request;
  forward.config.look_back = false;
  Prepared p = prepare_run(forward, hooks);
  if (const auto found = look_ahead_of(request, hooks, p)) {
    save_person({found->start.person, p.tracker->camera(), found->image}, file);
    return found->start.person;
  }
  std::string reason = "the input holds no frame that can be read";
  std::int64_t frames = 0;
  while (request.most_frames == 0 || frames < request.most_frames) {
    const auto frame = p.scene.next(*p.source);
    if (!frame) {
      break;
    }
    ++frames;
    const TrackedFrame result = p.tracker->step(*frame);
    if (p.tracker->calibration()) {
      save_person({*p.tracker->calibration(), p.tracker->camera(), p.tracker->features().calibration()},
                  file);
      return *p.tracker->calibration();
    }
    reason = result.note.empty() ? reason : result.note;
  }
  throw Error(ErrorKind::tracking,
              "no frame of " + p.source->info().name + " could be used to calibrate: " + reason,
              "Face the camera with the arms a little apart from the body.");
}

TrackSummary run_track(const TrackRequest& request, const RunHooks& hooks) {
  prepare_outputs(request);
  Prepared prepared = prepare_run(request, hooks);
  Tracker& tracker = *prepared.tracker;
  if (const auto found = look_ahead_of(request, hooks, prepared)) {
    tracker.start_with(found->start);
  }
  Run run(request, hooks, prepared.source->info(), tracker);
  bool interrupted = false;
  std::int64_t frames = 0;
  while (request.most_frames == 0 || frames < request.most_frames) {
    const std::optional<Frame> frame = prepared.scene.next(*prepared.source);
    if (!frame) {
      break;
    }
    ++frames;
    const Wish wish = run.step(*frame);
    if (wish == Wish::stop) {
      interrupted = true;
      break;
    }
    if (wish == Wish::recalibrate) {
      run.finish_person();
      tracker.recalibrate();
    }
  }
  if (frames == 0) {
    throw Error(ErrorKind::input, prepared.source->info().name + " holds no frame that can be read",
                prepared.source->complaint());
  }
  return run.finish(interrupted, prepared.source->complaint(), prepared.scene.messages);
}

}  // namespace telemime
