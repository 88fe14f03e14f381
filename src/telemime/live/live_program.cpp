// SPDX-License-Identifier: Apache-2.0
#include "telemime/live/live_program.h"

#include <sys/resource.h>

#include <atomic>
#include <charconv>
#include <chrono>
#include <condition_variable>
#include <fstream>
#include <iterator>
#include <mutex>
#include <thread>
#include <utility>

#include "telemime/core/errors.h"
#include "telemime/live/avatar_shelf.h"
#include "telemime/live/commands.h"
#include "telemime/live/live_messages.h"
#include "telemime/live/page_files.h"
#include "telemime/live/recorder.h"
#include "telemime/live/sender_list.h"
#include "telemime/network/pose_message.h"

namespace telemime {
namespace {

// Of WebServer: of all but the first only the newest waits.
enum Topic : int { kWords = 0, kPose = 1, kStatus = 2, kPicture = 3 };

constexpr double kMs = 1000.0;
constexpr auto kTick = std::chrono::milliseconds(500);
constexpr int kPatience = 10;  // ticks without a page until the guided start is skipped

std::shared_ptr<const std::string> shared(std::string text) {
  return std::make_shared<const std::string>(std::move(text));
}

double cpu_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

// "/recordings/3/motion.bvh" in its parts.
std::optional<std::pair<int, std::string>> recorded_name(std::string_view path) {
  constexpr std::string_view kFolder = "/recordings/";
  if (!path.starts_with(kFolder)) {
    return std::nullopt;
  }
  path.remove_prefix(kFolder.size());
  int number = 0;
  const auto [end, failure] = std::from_chars(path.data(), path.data() + path.size(), number);
  if (failure != std::errc() || end == path.data() + path.size() || *end != '/') {
    return std::nullopt;
  }
  return std::pair{number, std::string(end + 1, path.data() + path.size())};
}

}  // namespace

struct LiveProgram::State {
  State(const LiveRequest& asked, std::unique_ptr<Source> source,
        std::function<void(const std::string&)> message)
      : options(asked),
        console(std::move(message)),
        recorder(asked.recordings, asked.request.output_options,
                 [this](const std::string& words) { tell(MessageLevel::info, words); }) {
    for (const std::string& url : options.send) {
      senders.add(url);
    }
    server = std::make_unique<WebServer>(
        options.web,
        WebHandlers{[this](const std::string& path) { return content(path); },
                    [this](std::uint64_t) { return greeting(); },
                    [this](std::uint64_t client, std::string_view text) { return answer(client, text); },
                    {}});
    LiveHooks hooks;
    hooks.picture = [this](const Frame& frame) { show(frame); };
    hooks.person = [this](const StreamHeader& header) { meet(header); };
    hooks.motion = [this](const MotionFrame& frame, double taken) { hand_out(frame, taken); };
    hooks.message = [this](MessageLevel level, const std::string& words) { tell(level, words); };
    info = source->info();
    session = std::make_unique<LiveSession>(options.request, options.guided, std::move(source), hooks, clock);
    {
      const std::lock_guard lock(mutex);
      hello = hello_message(options.version, info, session->camera());
    }
    ready = true;
    for (const std::string& text : greeting()) {  // to pages that came before there was anything to say
      server->send_text(kWords, shared(text));
    }
    painter = std::thread([this] { paint(); });
    ticker = std::thread([this] { tick(); });
  }

  ~State() {
    {
      const std::lock_guard lock(mutex);
      stop = true;
    }
    changed.notify_all();
    if (ticker.joinable()) {
      ticker.join();
      painter.join();
    }
    // The server's handlers use the session and the recorder until it is gone; their messages use the server.
    if (session) {
      session->stop();
    }
    recorder.close();
    server.reset();
  }

  void tell(MessageLevel level, const std::string& words) {
    if (console) {
      console(words);
    }
    const auto message = shared(words_message(level, words));
    if (server) {
      server->send_text(kWords, message);
    }
  }

  std::optional<WebContent> content(const std::string& path) {
    constexpr std::string_view kFolder = "/avatars/";
    constexpr std::string_view kEnding = ".vrm";
    if (path.starts_with(kFolder) && path.ends_with(kEnding)) {
      const std::string look = path.substr(kFolder.size(), path.size() - kFolder.size() - kEnding.size());
      const auto bytes = avatars.get(look);
      return bytes ? std::optional(WebContent{bytes, "model/gltf-binary", "", false}) : std::nullopt;
    }
    if (const auto name = recorded_name(path)) {
      return recorded(name->first, name->second);
    }
    return page_file(path);
  }

  std::optional<WebContent> recorded(int number, const std::string& name) const {
    const auto file = recorder.file(number, name);
    if (!file) {
      return std::nullopt;
    }
    std::ifstream in(*file, std::ios::binary);
    if (!in) {
      return std::nullopt;
    }
    std::string bytes((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
    return WebContent{shared(std::move(bytes)), "application/octet-stream",
                      "telemime-" + std::to_string(number) + "-" + name, false};
  }

  std::vector<std::string> greeting() {
    std::vector<std::string> messages;
    if (!ready) {
      return messages;
    }
    {
      const std::lock_guard lock(mutex);
      for (const std::string& text : {hello, body}) {
        if (!text.empty()) {
          messages.push_back(text);
        }
      }
    }
    messages.push_back(status());
    return messages;
  }

  std::optional<std::string> answer(std::uint64_t client, std::string_view text) {
    if (!ready) {
      return words_message(MessageLevel::error, "the program is still starting; try again");
    }
    try {
      return std::visit([&](const auto& command) { return carry_out(client, command); }, parse_command(text));
    } catch (const Error& e) {
      return words_message(MessageLevel::error, e.what());
    }
  }

  using Answer = std::optional<std::string>;
  Answer carry_out(std::uint64_t, const Guide& c) {
    session->guide(c.step);
    return std::nullopt;
  }
  Answer carry_out(std::uint64_t, const Recalibrate&) {
    session->recalibrate();
    return std::nullopt;
  }
  Answer carry_out(std::uint64_t, const AddOutput& c) {
    senders.add(c.url);
    tell_status();
    return std::nullopt;
  }
  Answer carry_out(std::uint64_t, const RemoveOutput& c) {
    if (!senders.remove(c.url)) {
      return words_message(MessageLevel::error, c.url + " is not among the outputs");
    }
    tell_status();
    return std::nullopt;
  }
  Answer carry_out(std::uint64_t, const Record& c) {
    c.on ? recorder.start() : recorder.stop();
    return std::nullopt;
  }
  Answer carry_out(std::uint64_t, const Forget& c) {
    if (!recorder.forget(c.number)) {
      return words_message(MessageLevel::error, "there is no recording " + std::to_string(c.number));
    }
    tell_status();
    return std::nullopt;
  }
  Answer carry_out(std::uint64_t client, const Pictures& c) {
    server->set_topic(client, kPicture, c.on);
    return std::nullopt;
  }
  Answer carry_out(std::uint64_t, const Drawn& c) {
    const double now = clock.now();
    const std::lock_guard lock(mutex);
    latency.add(kMs * now - c.stamp);
    return std::nullopt;
  }
  Answer carry_out(std::uint64_t, const Ping& c) { return pong_message(c.id, kMs * clock.now()); }

  // The image side: only leaves the picture for the painter.
  void show(const Frame& frame) {
    if (server->clients() == 0) {
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
      server->send_binary(kPicture, shared(picture_message(frame.image, frame.index, kMs * frame.taken)));
    }
  }

  void meet(const StreamHeader& header) {
    spoken = std::make_unique<PoseMessages>(header);
    const std::string text = spoken->body();
    {
      const std::lock_guard lock(mutex);
      body = text;  // first: a page that comes now is told by its greeting, or by the message
    }
    server->send_text(kWords, shared(text));
    senders.person(header);
    recorder.person(header);
  }

  void hand_out(const MotionFrame& frame, double taken) {
    const std::string text = spoken->pose(frame, kMs * taken);
    server->send_text(kPose, shared(text));
    senders.send(frame);
    recorder.write(frame);
  }

  std::string status() {
    LiveStatus now;
    now.state = session->state();
    now.outputs = senders.status();
    now.recording = recorder.current();
    now.recordings = recorder.ended();
    {
      const std::lock_guard lock(mutex);
      now.latency = latency.summary();
      now.cpu = cpu;
    }
    return status_message(now);
  }

  void tell_status() { server->send_text(kStatus, shared(status())); }

  void tick() {
    int alone = 0;
    double cpu_before = cpu_seconds();
    double before = clock.now();
    while (true) {
      {
        std::unique_lock lock(mutex);
        if (changed.wait_for(lock, kTick, [this] { return stop; })) {
          return;
        }
        const double cpu_now = cpu_seconds();
        const double now = clock.now();
        if (now > before) {
          cpu = 0.5 * cpu + 0.5 * (cpu_now - cpu_before) / (now - before);
        }
        cpu_before = cpu_now;
        before = now;
      }
      const bool waits = session->state().phase == LivePhase::empty_room;
      alone = waits && server->clients() == 0 ? alone + 1 : 0;
      if (alone == kPatience) {
        tell(MessageLevel::info,
             "no page is open to guide the start: going on without a picture of the empty room");
        session->guide(GuideStep::skip);
      }
      tell_status();
    }
  }

  LiveRequest options;
  std::function<void(const std::string&)> console;
  Clock clock = monotonic_clock();
  double began = clock.now();
  double cpu_at_start = cpu_seconds();
  SourceInfo info;
  SenderList senders;
  Recorder recorder;
  AvatarShelf avatars;
  std::atomic<bool> ready = false;       // the session is there
  std::unique_ptr<PoseMessages> spoken;  // of the search side

  mutable std::mutex mutex;  // of what follows
  std::condition_variable changed;
  bool stop = false;
  std::string hello;
  std::string body;
  std::optional<Frame> picture;
  LatencyRecord latency;
  double cpu = 0.0;

  std::unique_ptr<WebServer> server;
  std::unique_ptr<LiveSession> session;
  std::thread painter;
  std::thread ticker;
};

LiveProgram::LiveProgram(const LiveRequest& options, std::unique_ptr<Source> source,
                         std::function<void(const std::string&)> message)
    : state_(std::make_unique<State>(options, std::move(source), std::move(message))) {}

LiveProgram::~LiveProgram() = default;

std::uint16_t LiveProgram::port() const {
  return state_->server->port();
}

LiveReport LiveProgram::report() const {
  LiveReport report;
  report.state = state_->session->state();
  report.outputs = state_->senders.status();
  const double seconds = state_->clock.now() - state_->began;
  report.cpu = seconds > 0.0 ? (cpu_seconds() - state_->cpu_at_start) / seconds : 0.0;
  const std::lock_guard lock(state_->mutex);
  report.latency = state_->latency.summary();
  return report;
}

}  // namespace telemime
