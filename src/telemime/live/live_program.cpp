// SPDX-License-Identifier: Apache-2.0
#include "telemime/live/live_program.h"

#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <tuple>
#include <utility>

#include "telemime/core/errors.h"
#include "telemime/core/heap.h"
#include "telemime/live/guide_timeout.h"
#include "telemime/live/live_answers.h"
#include "telemime/live/live_files.h"
#include "telemime/live/live_messages.h"
#include "telemime/live/processor_time.h"
#include "telemime/live/saved_outputs.h"
#include "telemime/live/sender_state_reporter.h"
#include "telemime/streaming/pose_message.h"
#include "telemime/streaming/url.h"

namespace telemime {
namespace {

constexpr double kMs = 1000.0;
constexpr auto kTick = std::chrono::milliseconds(500);

std::shared_ptr<const std::string> shared(std::string text) {
  return std::make_shared<const std::string>(std::move(text));
}

}  // namespace

struct LiveProgram::State {
  State(const LiveRequest& asked, std::unique_ptr<Source> source, Message message)
      : options(asked),
        console(std::move(message)),
        recorder(asked.recordings, asked.request.output_options,
                 [this](MessageLevel level, const std::string& words) { tell(level, words); }),
        answers(
            recorder, senders, clock,
            {[this](std::uint64_t client, int topic, bool on) { server->set_topic(client, topic, on); },
             [this] { tell_status(); }, [this](std::uint64_t client) { return server->from_here(client); },
             [this](const std::string& url) { kept.keep(url); },
             [this](const std::string& url) { kept.forget(url); }}) {
    try {
      begin(std::move(source));
    } catch (...) {
      end();
      throw;
    }
  }

  ~State() { end(); }

  void begin(std::unique_ptr<Source> source) {
    for (const std::string& url : options.send) {
      senders.add(url);
    }
    kept.offer(options.resume_outputs);
    serve();
    LiveHooks hooks;
    hooks.picture = [this](const Frame& frame) { show(frame); };
    hooks.person = [this](const StreamHeader& header) { meet(header); };
    hooks.motion = [this](const MotionFrame& frame, double taken) { hand_out(frame, taken); };
    hooks.message = [this](MessageLevel level, const std::string& words) { hear(level, words); };
    const SourceInfo info = source->info();
    session = std::make_unique<LiveSession>(options.request, options.guided, std::move(source), hooks, clock);
    {
      const std::lock_guard lock(mutex);
      hello = hello_message(options.version, info, session->camera(), avatars.looks(), senders.kinds());
    }
    ready = session.get();
    answers.begin(*session);
    for (const std::string& text : greeting()) {  // to pages that came while there was little to say
      server->send_text(kWords, shared(text));
    }
    painter = std::thread([this] { paint(); });
    ticker = std::thread([this] { tick(); });
  }

  // Threads and handlers call each other: all of them stop before the first object goes.
  void end() {
    {
      const std::lock_guard lock(mutex);
      stop = true;
    }
    changed.notify_all();
    for (std::thread* const thread : {&ticker, &painter}) {
      if (thread->joinable()) {
        thread->join();
      }
    }
    // The server's handlers use the session and the recorder until it has stopped; their messages use the
    // server.
    if (session) {
      session->stop();
    }
    recorder.close();
    if (server) {
      server->stop();
    }
    kept.save();
  }

  void serve() {
    WebHandlers handlers;
    handlers.get = [this](const std::string& path) { return live_file(path, avatars, recorder); };
    handlers.opened = [this](std::uint64_t) { return greeting(); };
    handlers.text = [this](std::uint64_t client, std::string_view text) {
      return serving ? answers(client, text) : std::nullopt;
    };
    server = std::make_unique<WebServer>(options.web, handlers);
    serving = true;
  }

  void tell(MessageLevel level, const std::string& words) {
    if (console) {
      console(level, words);
    }
    if (serving && server) {
      server->send_text(kWords, shared(words_message(level, words)));
    }
  }

  // What the session says. It says an error when it ends by one.
  void hear(MessageLevel level, const std::string& words) {
    if (level == MessageLevel::error) {
      const std::lock_guard lock(mutex);
      if (session_error.empty()) {  // what fails later may fail of it
        session_error = words;
      }
    }
    tell(level, words);
  }

  std::vector<std::string> greeting() {
    std::vector<std::string> messages;
    {
      const std::lock_guard lock(mutex);
      for (const std::string& text : {hello, body}) {
        if (!text.empty()) {
          messages.push_back(text);
        }
      }
    }
    messages.push_back(status());
    if (const LiveSession* const running = ready) {
      for (const std::string& words : running->state().warnings) {  // told before this page was open
        messages.push_back(words_message(MessageLevel::warning, words));
      }
    }
    return messages;
  }

  // The image side: only leaves the picture for the painter.
  void show(const Frame& frame) {
    if (!server->wanted(kPicture)) {
      return;
    }
    {
      const std::lock_guard lock(mutex);
      picture = frame;
    }
    changed.notify_all();
  }

  void paint() {
    while (true) {
      Frame frame;
      {
        std::unique_lock lock(mutex);
        changed.wait(lock, [this] { return stop || picture; });
        if (stop) {
          return;
        }
        frame = *std::exchange(picture, std::nullopt);
      }
      attempt([&] {
        server->send_binary(kPicture, shared(picture_message(frame.image, frame.index, kMs * frame.taken)));
        ++pictures;
      });
    }
  }

  // What fails beside the tracking (memory is short, say) must not end it; told once.
  template <typename Work>
  void attempt(const Work& work) {
    try {
      work();
    } catch (const std::exception& e) {
      if (!complained.exchange(true) && console) {
        console(MessageLevel::error, std::string("the page is not told all: ") + e.what());
      }
    }
  }

  void meet(const StreamHeader& header) {
    spoken = std::make_unique<PoseMessages>(header);
    const std::string text = spoken->body();
    {
      const std::lock_guard lock(mutex);
      body = text;  // first: a page that connects now gets it with its greeting or as the message
    }
    server->send_text(kWords, shared(text));
    senders.person(header);
    recorder.person(header);
    give_heap_back();  // what the scene and the person were learned from
  }

  void hand_out(const MotionFrame& frame, double taken) {
    if (server->wanted(kPose)) {
      server->send_text(kPose, shared(spoken->pose(frame, kMs * taken)));
      ++poses;
    } else {
      spoken->pass(frame);
    }
    senders.send(frame, kMs * taken);
    recorder.write(frame);
  }

  std::string status() {
    LiveStatus now;
    if (const LiveSession* const running = ready) {
      now.state = running->state();
    } else {
      now.state.words = "the camera is made ready, and the scene is learned";
    }
    now.outputs = senders.status();
    now.recording = recorder.current();
    now.recordings = recorder.ended();
    now.latency = answers.latency();
    {
      const std::lock_guard lock(mutex);
      now.cpu = cores.value();
    }
    return status_message(now);
  }

  void tell_status() {
    if (server->clients() > 0) {
      server->send_text(kStatus, shared(status()));
    }
  }

  void tick() {
    bool told_end = false;
    while (true) {
      {
        std::unique_lock lock(mutex);
        if (changed.wait_for(lock, kTick, [this] { return stop; })) {
          return;
        }
        cores.read(clock.now(), processor_seconds());
      }
      attempt([&] {
        const LiveState now = session->state();
        wait_for_page(now.phase);
        if (now.phase == LivePhase::ended && !told_end) {
          tell_end(now.words);
          told_end = true;
        }
      });
      attempt([this] { kept.save(); });
      attempt([this] { tell_outputs(); });
      attempt([this] { tell_status(); });
    }
  }

  // Pages show the list of outputs; the console reports changes.
  void tell_outputs() {
    for (const SenderStateReporter::Report& report : sender_states.update(senders.status())) {
      if (console) {
        console(report.level, report.text);
      }
    }
  }

  // The empty room is asked for by a page.
  void wait_for_page(LivePhase phase) {
    switch (guide_timeout.update(phase == LivePhase::empty_room, server->clients(), clock.now())) {
      case GuideTimeout::Step::none:
        break;
      case GuideTimeout::Step::ask:
        tell(MessageLevel::warning,
             "waiting for the page, which guides the start: open " + page_url(options.web, server->port()) +
                 "\n  Without a page the start goes on by itself after " +
                 std::to_string(std::lround(guide_timeout.seconds())) + " s; --no-guide does not wait.");
        break;
      case GuideTimeout::Step::skip:
        tell(MessageLevel::warning,
             "no page is open to guide the start: going on without a picture of the empty room");
        session->guide(GuideStep::skip);
        break;
    }
  }

  void tell_end(const std::string& words) {
    const std::optional<LiveFailure> why = failure();
    if (why ? why->input : !words.empty()) {  // what failed inside was told when it did
      tell(why ? MessageLevel::error : MessageLevel::warning, words);
    }
  }

  std::optional<LiveFailure> failure() const {
    const LiveState now = session->state();
    if (now.phase != LivePhase::ended) {
      return std::nullopt;
    }
    {
      const std::lock_guard lock(mutex);
      if (!session_error.empty()) {
        return LiveFailure{false, session_error};
      }
    }
    return !options.ends && !now.words.empty() ? std::optional(LiveFailure{true, now.words}) : std::nullopt;
  }

  LiveRequest options;
  Message console;
  Clock clock = monotonic_clock();
  double began = clock.now();
  double cpu_at_start = processor_seconds();
  std::atomic<bool> serving = false;  // the server is there
  SenderList senders{options.sender_kinds};
  SavedOutputs kept{options.settings, senders,
                    [this](MessageLevel level, const std::string& words) { tell(level, words); }};
  Recorder recorder;
  AvatarFolder avatars{options.avatars};
  LiveAnswers answers;
  std::atomic<const LiveSession*> ready = nullptr;
  std::atomic<std::int64_t> poses = 0;
  std::atomic<std::int64_t> pictures = 0;
  std::unique_ptr<PoseMessages> spoken;           // of the search side
  GuideTimeout guide_timeout{options.page_wait};  // of the ticker
  SenderStateReporter sender_states;              // of the ticker
  std::atomic<bool> complained = false;

  mutable std::mutex mutex;  // of what follows
  std::condition_variable changed;
  bool stop = false;
  std::string hello;
  std::string body;
  std::string session_error;
  std::optional<Frame> picture;
  CoresInUse cores{began, cpu_at_start};

  std::unique_ptr<WebServer> server;
  std::unique_ptr<LiveSession> session;
  std::thread painter;
  std::thread ticker;
};

LiveProgram::LiveProgram(const LiveRequest& options, std::unique_ptr<Source> source, Message message)
    : state_(std::make_unique<State>(options, std::move(source), std::move(message))) {}

LiveProgram::~LiveProgram() = default;

std::uint16_t LiveProgram::port() const {
  return state_->server->port();
}

LiveReport LiveProgram::report() const {
  LiveReport report;
  report.state = state_->session->state();
  report.outputs = state_->senders.status();
  report.failure = state_->failure();
  report.pages = state_->server->clients();
  report.poses = state_->poses;
  report.pictures = state_->pictures;
  const double seconds = state_->clock.now() - state_->began;
  report.cpu = seconds > 0.0 ? (processor_seconds() - state_->cpu_at_start) / seconds : 0.0;
  report.latency = state_->answers.latency();
  return report;
}

std::string page_url(const WebServerOptions& web, std::uint16_t port) {
  const bool here =
      web.address == "127.0.0.1" || web.address == "0.0.0.0" || web.address == "::" || web.address == "::1";
  return "http://" + host_and_port(here ? "localhost" : web.address, port);
}

}  // namespace telemime
