// SPDX-License-Identifier: Apache-2.0
#include "telemime/live/live_session.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "telemime/pipeline/scene.h"
#include "telemime/pipeline/set_up.h"
#include "telemime/pipeline/told.h"
#include "telemime/smoothing/smoother.h"

namespace telemime {
namespace {

constexpr double kStopped = 2.0;  // s without a picture

struct Slot {
  SeenFrame seen;
  FrameTimes times;
};

// What the user asked for since the last frame.
struct Wishes {
  std::optional<GuideStep> guide;
  bool recalibrate = false;
};

}  // namespace

struct LiveSession::State {
  State(const TrackRequest& asked, bool guide, std::unique_ptr<Source> input, LiveHooks calls, Clock time)
      : request(asked), source(std::move(input)), hooks(std::move(calls)), clock(std::move(time)) {
    request.config.look_back = false;  // there is nothing to look back from
    std::vector<std::string> messages;
    tracker = make_tracker(request, source->info(), messages);
    scene_known = !request.calibration.empty();
    if (!request.background.empty() && !scene_known) {
      const Footage scene = learn_scene(request, source->info(), *source, *tracker);
      messages.insert(messages.end(), scene.messages.begin(), scene.messages.end());
      scene_known = true;
    }
    phase = scene_known ? LivePhase::person : guide ? LivePhase::empty_room : LivePhase::background;
    settled = tracker->settled();
    for (const std::string& words : messages) {
      say(words);
    }
  }

  void say(const std::string& words, MessageLevel level = MessageLevel::info) const {
    if (hooks.message) {
      hooks.message(level, words);
    }
  }

  void enter(LivePhase next, const std::string& why) {
    const std::lock_guard lock(mutex);
    phase = next;
    reason = why;
  }

  // The next picture; nothing at the end.
  std::optional<Frame> take() {
    {
      const std::lock_guard lock(mutex);
      waiting_since = clock.now();
    }
    std::optional<Frame> frame = source->next();
    {
      const std::lock_guard lock(mutex);
      waiting_since.reset();
    }
    if (frame && hooks.picture) {
      hooks.picture(*frame);
    }
    return frame;
  }

  bool stopping() const {
    const std::lock_guard lock(mutex);
    return stop;
  }

  void stop_all() {
    {
      const std::lock_guard lock(mutex);
      stop = true;
    }
    changed.notify_all();
    source->stop();
  }

  // The image side's thread.
  void see() {
    guarded([this] {
      std::size_t mine = 0;
      while (!stopping()) {
        follow_wishes();
        const LivePhase now = current();
        if (now == LivePhase::empty_room) {
          if (!take()) {
            break;
          }
        } else if (now == LivePhase::background) {
          if (!learn_background()) {
            break;
          }
        } else if (!look(slots[mine])) {
          break;
        } else {
          mine = 1 - mine;
        }
      }
    });
    wait_for_search();
    if (!stopping()) {
      leave_person();
      const std::string complaint = source->complaint();
      enter(LivePhase::ended, failure.empty() ? complaint : failure);
    }
    stop_search();
  }

  LivePhase current() const {
    const std::lock_guard lock(mutex);
    return phase;
  }

  // Waits until the search has nothing to do; false when all is to stop.
  bool wait_for_search() {
    std::unique_lock lock(mutex);
    changed.wait(lock, [this] { return stop || search_stop || (ready == nullptr && !busy); });
    return !stop;
  }

  void follow_wishes() {
    Wishes asked;
    {
      const std::lock_guard lock(mutex);
      asked = std::exchange(wishes, {});
    }
    if (asked.guide == GuideStep::empty || asked.guide == GuideStep::skip) {
      empty_promised = asked.guide == GuideStep::empty;
      if (current() == LivePhase::empty_room) {
        enter(LivePhase::background, "");
      }
    }
    if ((asked.recalibrate || asked.guide == GuideStep::again) && wait_for_search()) {
      tracker->recalibrate();
      leave_person();
      {
        const std::lock_guard lock(mutex);
        settled = false;
        told.forget();
      }
      if (asked.guide == GuideStep::again) {
        enter(LivePhase::empty_room, "");
      } else if (current() == LivePhase::tracking || current() == LivePhase::lost) {
        enter(LivePhase::person, "");
      }
    }
  }

  // Receivers are told that the person is gone; while the search has nothing to do.
  void leave_person() {
    if (last_motion && hooks.motion) {
      last_motion->state = TrackState::lost;
      hooks.motion(*last_motion, last_taken);
    }
    last_motion.reset();
  }

  // Of about a second of pictures; false at the end of the input.
  bool learn_background() {
    std::vector<Frame> frames;
    const auto count = static_cast<std::size_t>(std::clamp(source->info().fps, 8.0, 60.0));
    while (frames.size() < count) {
      auto frame = take();
      if (!frame) {
        break;
      }
      frames.push_back(std::move(*frame));
      if (stopping()) {
        return false;
      }
    }
    if (frames.empty()) {
      return false;
    }
    if (empty_promised) {
      tracker->learn_background(frames);
      say("background: the empty room, from " + std::to_string(frames.size()) + " pictures");
    } else {
      say("background: " + tracker->bootstrap(frames).sentence);
    }
    const std::lock_guard lock(mutex);
    phase = LivePhase::person;
    reason.clear();
    statistics.clear();  // what was not looked at in the meantime was not dropped
    return true;
  }

  // The next frame's features, and over to the search; false at the end.
  bool look(Slot& slot) {
    bool known = false;
    {
      std::unique_lock lock(mutex);
      // What is not taken yet is in the other slot; before a person is known the search has a say in what the
      // image side learns.
      changed.wait(lock, [this] { return stop || search_stop || (ready == nullptr && (settled || !busy)); });
      if (stop || search_stop) {
        return false;
      }
      known = settled;
    }
    const std::optional<Frame> frame = take();
    if (!frame) {
      return false;
    }
    slot.times = {frame->index, frame->taken, clock.now(), 0.0, 0.0, 0.0};
    tracker->look(*frame, known, slot.seen);
    slot.times.seen = clock.now();
    {
      const std::lock_guard lock(mutex);
      ready = &slot;
    }
    changed.notify_all();
    return true;
  }

  // The search side's thread.
  void search() {
    guarded([this] {
      while (true) {
        Slot* slot = nullptr;
        {
          std::unique_lock lock(mutex);
          changed.wait(lock, [this] { return stop || search_stop || ready != nullptr; });
          if (stop || (search_stop && ready == nullptr)) {
            return;
          }
          slot = std::exchange(ready, nullptr);
          busy = true;
        }
        changed.notify_all();
        decide(*slot);
        {
          const std::lock_guard lock(mutex);
          busy = false;
        }
        changed.notify_all();
      }
    });
    stop_search();
  }

  void stop_search() {
    {
      const std::lock_guard lock(mutex);
      search_stop = true;
      busy = false;
    }
    changed.notify_all();
  }

  void decide(Slot& slot) {
    slot.times.searched = clock.now();
    bool was_settled = false;
    {
      const std::lock_guard lock(mutex);
      was_settled = settled && smoother != nullptr;
    }
    const TrackedFrame result = tracker->decide(slot.seen);
    if (tracker->settled() && !was_settled) {
      const StreamHeader header = header_of(source->info(), *tracker);
      SmoothingOptions smoothing = request.config.smoothing;
      smoother = make_smoother(smoothing, header.body, header.camera);
      if (hooks.person) {
        hooks.person(header);
      }
    }
    for (const std::string& words : result.warnings) {
      if (told.is_new(words)) {
        say(words, MessageLevel::warning);
      }
    }
    if (tracker->settled() && hooks.motion) {
      last_motion = (*smoother)(result.motion);
      last_taken = slot.seen.frame.taken;
      hooks.motion(*last_motion, last_taken);
    }
    slot.times.decided = clock.now();
    const std::lock_guard lock(mutex);
    settled = tracker->settled();
    statistics.add(slot.times);
    reason = result.note;
    phase = result.motion.state == TrackState::tracking ? LivePhase::tracking
            : settled                                   ? LivePhase::lost
                                                        : LivePhase::person;
  }

  // What fails in a thread ends the run, in words.
  template <typename Work>
  void guarded(const Work& work) {
    try {
      work();
    } catch (const std::exception& e) {
      say(e.what(), MessageLevel::error);
      const std::lock_guard lock(mutex);
      failure = e.what();
    }
  }

  TrackRequest request;
  std::unique_ptr<Source> source;
  LiveHooks hooks;
  Clock clock;
  std::unique_ptr<Tracker> tracker;  // look() of one thread beside decide() of the other
  bool scene_known = false;
  bool empty_promised = false;             // of the image side: the user says that the room is empty
  std::array<Slot, 2> slots;               // one being looked at, one being searched
  std::optional<MotionFrame> last_motion;  // of the search side, handed out
  double last_taken = 0.0;                 // of the same frame
  std::unique_ptr<Smoother> smoother;      // of the search side

  mutable std::mutex mutex;  // of what follows
  std::condition_variable changed;
  Slot* ready = nullptr;  // looked at, and not yet taken by the search
  bool busy = false;      // the search is at work
  bool settled = false;
  bool stop = false;
  bool search_stop = false;  // when what is ready is done
  Wishes wishes;
  LivePhase phase = LivePhase::person;
  std::string reason;  // in words, why nobody is tracked
  std::string failure;
  std::optional<double> waiting_since;  // for a picture, s of the clock
  LiveStatistics statistics;
  Told told;

  std::thread image_side;
  std::thread search_side;
};

LiveSession::LiveSession(const TrackRequest& request, bool guided, std::unique_ptr<Source> source,
                         LiveHooks hooks, Clock clock)
    : state_(
          std::make_unique<State>(request, guided, std::move(source), std::move(hooks), std::move(clock))) {
  state_->search_side = std::thread([s = state_.get()] { s->search(); });
  state_->image_side = std::thread([s = state_.get()] { s->see(); });
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
  state_->wishes.guide = step;
}

void LiveSession::recalibrate() {
  const std::lock_guard lock(state_->mutex);
  state_->wishes.recalibrate = true;
}

LiveState LiveSession::state() const {
  const double now = state_->clock.now();
  const std::lock_guard lock(state_->mutex);
  LiveState state{state_->phase, state_->reason, state_->statistics.rates(now)};
  if (state.phase != LivePhase::ended && state_->waiting_since && now - *state_->waiting_since > kStopped) {
    state.phase = LivePhase::stopped;
    state.words = "the camera gives no pictures now";
  }
  return state;
}

const SourceInfo& LiveSession::info() const {
  return state_->source->info();
}

const Camera& LiveSession::camera() const {
  return state_->tracker->camera();
}

}  // namespace telemime
