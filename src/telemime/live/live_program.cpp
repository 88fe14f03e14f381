// SPDX-License-Identifier: Apache-2.0
#include "telemime/live/live_program.h"

#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>

#include "telemime/core/heap.h"
#include "telemime/live/live_answers.h"
#include "telemime/live/live_files.h"
#include "telemime/live/live_messages.h"
#include "telemime/live/live_monitors.h"
#include "telemime/live/saved_outputs.h"
#include "telemime/live/virtual_camera.h"
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
                 [this](MessageLevel level, const std::string& words) { notify(level, words); }),
        answers(
            recorder, senders, clock,
            {[this](std::uint64_t client, int topic, bool on) { server->set_topic(client, topic, on); },
             [this] { send_status(); }, [this](std::uint64_t client) { return server->from_here(client); },
             [this](const std::string& url) { saved_outputs.keep(url); },
             [this](const std::string& url) { saved_outputs.forget(url); }}) {
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
    saved_outputs.offer(options.resume_outputs);
    serve();
    camera = std::make_unique<VirtualCamera>(
        options.virtual_camera.empty() ? nullptr : std::make_unique<VideoOutput>(options.virtual_camera),
        [this](MessageLevel level, const std::string& words) { notify(level, words); });
    LiveHooks hooks;
    hooks.picture = [this](const Frame& frame) { keep_picture(frame); };
    hooks.person = [this](const StreamHeader& header) { on_person(header); };
    hooks.motion = [this](const MotionFrame& frame, double taken) { on_motion(frame, taken); };
    hooks.message = [this](MessageLevel level, const std::string& words) {
      on_session_message(level, words);
    };
    const SourceInfo info = source->info();
    session = std::make_unique<LiveSession>(options.request, options.guided, std::move(source), hooks, clock);
    {
      const std::lock_guard lock(mutex);
      hello = hello_message(options.version, info.name, options.camera, session->camera(), avatars.looks(),
                            senders.kinds());
    }
    ready = session.get();
    answers.begin(*session);
    for (const std::string& text : first_messages()) {  // to pages that came while there was little to say
      server->send_text(kWords, shared(text));
    }
    picture_thread = std::thread([this] { send_pictures(); });
    ticker = std::thread([this] { tick(); });
  }

  // Threads and handlers call each other: all of them stop before the first object goes.
  void end() {
    {
      const std::lock_guard lock(mutex);
      stop = true;
    }
    changed.notify_all();
    for (std::thread* const thread : {&ticker, &picture_thread}) {
      if (thread->joinable()) {
        thread->join();
      }
    }
    // The server's handlers use the session and the recorder until it has stopped; their messages use the
    // server.
    if (session) {
      session->stop();
    }
    camera.reset();
    recorder.close();
    if (server) {
      server->stop();
    }
    saved_outputs.save();
  }

  void serve() {
    WebHandlers handlers;
    handlers.get = [this](const std::string& path) { return live_file(path, avatars, recorder); };
    handlers.opened = [this](std::uint64_t) { return first_messages(); };
    handlers.text = [this](std::uint64_t client, std::string_view text) {
      return serving ? answers(client, text) : std::nullopt;
    };
    server = std::make_unique<WebServer>(options.web, handlers);
    serving = true;
  }

  void notify(MessageLevel level, const std::string& words) {
    if (console) {
      console(level, words);
    }
    if (serving && server) {
      server->send_text(kWords, shared(words_message(level, words)));
    }
  }

  // Messages of the session. Its first error is the reason for its end.
  void on_session_message(MessageLevel level, const std::string& words) {
    if (level == MessageLevel::error) {
      const std::lock_guard lock(mutex);
      if (session_error.empty()) {  // what fails later may fail of it
        session_error = words;
      }
    }
    notify(level, words);
  }

  std::vector<std::string> first_messages() {
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
      for (const std::string& words : running->state().warnings) {  // reported before this page was open
        messages.push_back(words_message(MessageLevel::warning, words));
      }
    }
    return messages;
  }

  // The image side: only leaves the picture for the picture_thread.
  void keep_picture(const Frame& frame) {
    camera->picture(frame);
    if (!server->wanted(kPicture)) {
      return;
    }
    {
      const std::lock_guard lock(mutex);
      picture = frame;
    }
    changed.notify_all();
  }

  void send_pictures() {
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

  // A failure beside the tracking (out of memory, for example) must not end it; reported once.
  template <typename Work>
  void attempt(const Work& work) {
    try {
      work();
    } catch (const std::exception& e) {
      if (!failure_reported.exchange(true) && console) {
        console(MessageLevel::error, std::string("the page does not receive everything: ") + e.what());
      }
    }
  }

  void on_person(const StreamHeader& header) {
    pose_messages = std::make_unique<PoseMessages>(header);
    const std::string text = pose_messages->body();
    {
      const std::lock_guard lock(mutex);
      body = text;  // first: a page that connects now gets it with its first messages or as this message
    }
    server->send_text(kWords, shared(text));
    senders.person(header);
    recorder.person(header);
    camera->person(header);
    give_heap_back();  // what the scene and the person were learned from
  }

  void on_motion(const MotionFrame& frame, double taken) {
    if (server->wanted(kPose)) {
      server->send_text(kPose, shared(pose_messages->pose(frame, kMs * taken)));
      ++poses;
    } else {
      pose_messages->pass(frame);
    }
    senders.send(frame, kMs * taken);
    recorder.write(frame);
    camera->motion(frame);
  }

  std::string status() {
    LiveStatus now;
    if (const LiveSession* const running = ready) {
      now.state = running->state();
    } else {
      now.state.words = "preparing the camera and learning the scene";
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

  void send_status() {
    if (server->clients() > 0) {
      server->send_text(kStatus, shared(status()));
    }
  }

  void tick() {
    bool end_reported = false;
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
        check_guide(now.phase);
        if (now.phase == LivePhase::ended && !end_reported) {
          report_end(now.words);
          end_reported = true;
        }
      });
      attempt([this] { saved_outputs.save(); });
      attempt([this] { report_sender_states(); });
      attempt([this] { send_status(); });
    }
  }

  // Pages show the list of outputs; the console reports changes.
  void report_sender_states() {
    for (const SenderStateReporter::Report& report : sender_states.update(senders.status())) {
      if (console) {
        console(report.level, report.text);
      }
    }
  }

  // A page that shows the camera asks the user for the empty room; that of the avatar alone does not.
  void check_guide(LivePhase phase) {
    const std::size_t pages = server->wanted(kPicture) ? server->clients() : 0;
    switch (guide_timeout.update(phase == LivePhase::empty_room, pages, clock.now())) {
      case GuideTimeout::Step::none:
        break;
      case GuideTimeout::Step::ask:
        notify(MessageLevel::warning,
               "waiting for the page, which guides the start: open " + page_url(options.web, server->port()) +
                   " and keep it visible\n  Without it, tracking starts after " +
                   std::to_string(std::lround(guide_timeout.seconds())) + " s; --no-guide does not wait.");
        break;
      case GuideTimeout::Step::skip:
        notify(MessageLevel::warning,
               "no visible page guides the start: continuing without an image of the empty room");
        session->guide(GuideStep::skip);
        break;
    }
  }

  void report_end(const std::string& words) {
    const std::optional<LiveFailure> why = failure();
    if (why ? why->input : !words.empty()) {  // internal failures were reported when they happened
      notify(why ? MessageLevel::error : MessageLevel::warning, words);
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
  SavedOutputs saved_outputs{options.settings, senders,
                             [this](MessageLevel level, const std::string& words) { notify(level, words); }};
  Recorder recorder;
  AvatarFolder avatars{options.avatars, options.more_avatars};
  LiveAnswers answers;
  std::atomic<const LiveSession*> ready = nullptr;
  std::atomic<std::int64_t> poses = 0;
  std::atomic<std::int64_t> pictures = 0;
  std::unique_ptr<PoseMessages> pose_messages;    // of the search side
  GuideTimeout guide_timeout{options.page_wait};  // of the ticker
  SenderStateReporter sender_states;              // of the ticker
  std::atomic<bool> failure_reported = false;

  mutable std::mutex mutex;  // of what follows
  std::condition_variable changed;
  bool stop = false;
  std::string hello;
  std::string body;
  std::string session_error;
  std::optional<Frame> picture;
  CoresInUse cores{began, cpu_at_start};

  std::unique_ptr<WebServer> server;
  std::unique_ptr<VirtualCamera> camera;
  std::unique_ptr<LiveSession> session;
  std::thread picture_thread;
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
