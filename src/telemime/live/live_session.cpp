// SPDX-License-Identifier: Apache-2.0
#include "telemime/live/live_session.h"

#include <exception>
#include <map>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "telemime/live/background_frames.h"
#include "telemime/live/frame_exchange.h"
#include "telemime/live/pace.h"
#include "telemime/tracker/message_deduplicator.h"
#include "telemime/tracker/scene.h"
#include "telemime/tracker/set_up.h"
#include "telemime/tracker/smoother.h"

namespace telemime {
namespace {

constexpr double kStopped = 2.0;  // s without a picture
constexpr double kMs = 1000.0;    // of a second

// What the user asked for since the last frame.
struct UserRequests {
  std::optional<GuideStep> guide;
  bool recalibrate = false;
};

}  // namespace

struct LiveSession::State {
  State(const TrackRequest& asked, bool guide, std::unique_ptr<Source> input, LiveHooks calls, Clock time)
      : request(asked),
        source(without_distortion(std::move(input), asked)),
        hooks(std::move(calls)),
        clock(std::move(time)),
        last_stamp(clock.now()) {
    request.config.look_back = false;  // there is nothing to look back from
    std::vector<std::string> messages;
    run = open_run(request, source->info(), messages);
    bool scene_known = !request.calibration.empty();
    if (!request.background.empty() && !scene_known) {
      messages.push_back(learn_scene(request, source->info(), *run));
      scene_known = true;
    }
    // Networks find the person in any room: the background is learned on the way.
    scene_known = scene_known || (run->scene.features.has_networks() && !guide);
    phase = scene_known ? LivePhase::person : guide ? LivePhase::empty_room : LivePhase::background;
    exchange.set_calibrated(run->state.calibrated());
    for (const std::string& words : messages) {
      report(words);
    }
    source->attend([this](const SourceNews& news) { on_source_news(news); });
  }

  void report(const std::string& words, MessageLevel level = MessageLevel::info) const {
    if (hooks.message) {
      hooks.message(level, words);
    }
  }

  void enter(LivePhase next, const std::string& why) {
    const std::lock_guard lock(mutex);
    phase = next;
    reason = why;
  }

  LivePhase current() const {
    const std::lock_guard lock(mutex);
    return phase;
  }

  // The next frame; nothing at the end of the input, or when the session stops.
  std::optional<Frame> next_frame() {
    {
      const std::lock_guard lock(mutex);
      waiting_since = clock.now();
    }
    std::optional<Frame> frame = source->next();
    {
      const std::lock_guard lock(mutex);
      waiting_since.reset();
      camera_words.clear();
      opened = true;
    }
    if (!frame || exchange.stopping()) {
      return std::nullopt;
    }
    frame->taken = last_stamp = usable_stamp(frame->taken, last_stamp, clock.now());
    if (hooks.picture) {
      hooks.picture(*frame);
    }
    return frame;
  }

  void on_source_news(const SourceNews& news) {  // called from within next_frame()
    using Change = SourceNews::Kind;
    {
      const std::lock_guard lock(mutex);
      if (news.kind == Change::better) {
        camera_warnings.erase(news.matter);
      } else {
        camera_warnings[news.matter] = news.words;
      }
    }
    report(news.words, news.kind == Change::better ? MessageLevel::info : MessageLevel::warning);
    if (news.kind == Change::gone) {
      {
        const std::lock_guard lock(mutex);
        camera_words = news.words;
        person_warnings.clear();
      }
      if (exchange.wait_for_search()) {
        report_lost();
        const std::lock_guard lock(mutex);
        statistics.clear();  // times across the gap mean nothing
      }
    }
  }

  void stop_all() {
    exchange.stop();
    source->stop();
  }

  // The function of the image thread.
  void run_image_side() {
    guarded([this] {
      bool more = true;
      while (more && !exchange.stopping()) {
        apply_requests();
        const LivePhase now = current();
        more = now == LivePhase::empty_room   ? next_frame().has_value()
               : now == LivePhase::background ? learn_background()
                                              : extract_next();
      }
    });
    exchange.wait_for_search();
    if (!exchange.stopping()) {
      guarded([this] { report_lost(); });  // what failed before may fail again
      enter(LivePhase::ended, failure.empty() ? source->complaint() : failure);
    }
    exchange.finish();
  }

  void apply_requests() {
    UserRequests asked;
    {
      const std::lock_guard lock(mutex);
      asked = std::exchange(requests, {});
    }
    if (asked.guide == GuideStep::empty || asked.guide == GuideStep::skip) {
      {
        const std::lock_guard lock(mutex);
        scene_is_empty = asked.guide == GuideStep::empty;
      }
      if (current() == LivePhase::empty_room) {
        enter(LivePhase::background, "");
      }
    }
    if ((asked.recalibrate || asked.guide == GuideStep::again) && exchange.wait_for_search()) {
      forget_person(*run);
      report_lost();
      exchange.set_calibrated(false);
      reported.forget();
      {
        const std::lock_guard lock(mutex);
        person_warnings.clear();
      }
      if (asked.guide == GuideStep::again) {
        enter(LivePhase::empty_room, "");
      } else if (current() == LivePhase::tracking || current() == LivePhase::lost) {
        enter(LivePhase::person, "");
      }
    }
  }

  // Reports the person as lost, with the face at rest. Only while the search is idle.
  void report_lost() {
    if (last_motion && hooks.motion) {
      last_motion->state = TrackState::lost;
      last_motion->face.reset();
      hooks.motion(*last_motion, last_taken);
    }
    last_motion.reset();
  }

  // False at the end of the input.
  bool learn_background() {
    const auto frames = background_frames([this] { return next_frame(); }, run->tracker.config.image);
    if (frames.empty() || exchange.stopping()) {
      return false;
    }
    if (scene_is_empty) {
      run->scene.features.learn_background(frames);
      report("background: the empty room, from " + std::to_string(frames.size()) + " pictures");
    } else {
      report("background: " + run->scene.features.bootstrap(frames));
    }
    const std::lock_guard lock(mutex);
    phase = LivePhase::person;
    reason.clear();
    statistics.clear();  // frames of that time were not dropped
    return true;
  }

  // Passes the features of the next frame to the search; false at the end of the input.
  bool extract_next() {
    LiveSlot* const slot = exchange.free_slot();
    if (slot == nullptr) {
      return false;
    }
    const bool calibrated = exchange.calibrated();
    const std::optional<Frame> frame = next_frame();
    if (!frame) {
      return false;
    }
    slot->times = {.index = frame->index, .taken = frame->taken, .begun = clock.now()};
    // Until a person is calibrated the search is idle here, and its state may be read.
    const ColourRequest colours = calibrated ? ColourRequest::keep : colour_request(run->state);
    slot->record.frame = *frame;
    slot->record.features = extract(*frame, colours, run->scene);
    slot->times.seen = clock.now();
    slot->times.networks_ms = slot->record.features.networks_ms;
    run->scene.hands_in_turn = request.keep_pace && falls_behind(slot->times, extracted);
    exchange.publish();
    return true;
  }

  // The function of the search thread.
  void run_search_side() {
    const bool well = guarded([this] {
      while (LiveSlot* const slot = exchange.take()) {
        estimate_pose(*slot);
        exchange.done(run->state.calibrated());
      }
    });
    exchange.finish();
    if (!well) {
      source->stop();  // the image side may wait for a camera that never comes back
    }
  }

  void estimate_pose(LiveSlot& slot) {
    slot.times.searched = clock.now();
    const bool was_calibrated = exchange.calibrated() && smoother != nullptr;
    const double effort = request.keep_pace ? pace.effort() : 1.0;
    const FrameEstimate result = estimate(slot.record.features, run->tracker, run->state, effort);
    update_pace(slot.times);
    input_rate.add(slot.record.frame.index, slot.record.frame.time);
    const bool calibrated = run->state.calibrated();
    if (calibrated && !was_calibrated) {
      StreamHeader header = header_of(source->info(), *run);
      header.fps = input_rate.believable(header.fps);
      smoother = make_smoother(request.config.smoothing, header.body, header.camera);
      if (hooks.person) {
        hooks.person(header);
      }
    }
    {
      const std::lock_guard lock(mutex);
      person_warnings = slot.record.features.warnings;
    }
    for (const std::string& words : slot.record.features.warnings) {
      if (reported.first_time(words)) {
        report(words, MessageLevel::warning);
      }
    }
    if (calibrated && hooks.motion) {
      last_motion = (*smoother)(result.motion);
      last_taken = slot.record.frame.taken;
      hooks.motion(*last_motion, last_taken);
    }
    slot.times.decided = clock.now();
    const std::lock_guard lock(mutex);
    statistics.add(slot.times);
    reason = result.note;
    phase = result.motion.state == TrackState::tracking ? LivePhase::tracking
            : calibrated                                ? LivePhase::lost
                                                        : LivePhase::person;
  }

  // Counts only frames of a tracked person: finding one takes longer, but happens seldom.
  void update_pace(const FrameTimes& times) {
    const auto frames = static_cast<double>(times.index - followed.index);
    if (last_motion && last_motion->state == TrackState::tracking && frames > 0.0) {
      pace.searched(kMs * (clock.now() - times.searched), kMs * (times.taken - followed.taken) / frames);
    }
    followed = times;
  }

  // An exception in a thread is reported and ends the run; false then.
  template <typename Work>
  bool guarded(const Work& work) {
    try {
      work();
      return true;
    } catch (const std::exception& e) {
      report(e.what(), MessageLevel::error);
      const std::lock_guard lock(mutex);
      failure = failure.empty() ? e.what() : failure;
      return false;
    }
  }

  TrackRequest request;
  std::unique_ptr<Source> source;
  LiveHooks hooks;
  Clock clock;
  std::optional<TrackingRun> run;  // the scene is the image thread's, the state the search thread's
  FrameExchange exchange;
  double last_stamp;                       // of the image side: Frame::taken of the last frame
  std::optional<MotionFrame> last_motion;  // of the search side, handed out
  Pace pace;                               // of the search side
  FrameTimes extracted, followed;          // of the last frame on the image and on the search side
  double last_taken = 0.0;                 // of the same frame
  std::unique_ptr<Smoother> smoother;      // of the search side
  MessageDeduplicator reported;            // of the search thread

  mutable std::mutex mutex;  // guards what follows
  UserRequests requests;
  bool scene_is_empty = false;  // the user said so; changed by the image thread alone
  bool opened = false;          // the first frame has arrived
  LivePhase phase = LivePhase::person;
  std::string reason;  // why nobody is tracked, for the user
  std::string failure;
  std::optional<double> waiting_since;  // for a frame, s of the clock
  std::string camera_words;             // why there is none
  std::map<SourceNews::Matter, std::string> camera_warnings;
  std::vector<std::string> person_warnings;
  InputRate input_rate;  // of the search thread
  LiveStatistics statistics;

  std::thread image_side;
  std::thread search_side;
};

LiveSession::LiveSession(const TrackRequest& request, bool guided, std::unique_ptr<Source> source,
                         LiveHooks hooks, Clock clock)
    : state_(
          std::make_unique<State>(request, guided, std::move(source), std::move(hooks), std::move(clock))) {
  state_->search_side = std::thread([s = state_.get()] { s->run_search_side(); });
  state_->image_side = std::thread([s = state_.get()] { s->run_image_side(); });
}

LiveSession::~LiveSession() {
  stop();
}

void LiveSession::stop() {
  state_->stop_all();
  if (state_->image_side.joinable()) {
    state_->image_side.join();
    state_->search_side.join();
  }
}

void LiveSession::guide(GuideStep step) {
  const std::lock_guard lock(state_->mutex);
  state_->requests.guide = step;
}

void LiveSession::recalibrate() {
  const std::lock_guard lock(state_->mutex);
  state_->requests.recalibrate = true;
}

LiveState LiveSession::state() const {
  const double now = state_->clock.now();
  const std::lock_guard lock(state_->mutex);
  LiveState state{state_->phase, state_->reason, state_->statistics.rates(now), state_->scene_is_empty, {}};
  if (state.phase == LivePhase::ended) {
    return state;
  }
  for (const auto& [matter, words] : state_->camera_warnings) {
    state.warnings.push_back(words);
  }
  state.warnings.insert(state.warnings.end(), state_->person_warnings.begin(), state_->person_warnings.end());
  if (!state_->opened) {
    state.phase = LivePhase::opening;
    state.words = "waiting for the first image";
  }
  if (state_->waiting_since && now - *state_->waiting_since > kStopped) {
    state.phase = LivePhase::stopped;
    state.words = state_->camera_words.empty() ? "the camera delivers no images now" : state_->camera_words;
  }
  return state;
}

const Camera& LiveSession::camera() const {
  return state_->run->tracker.camera;
}

}  // namespace telemime
