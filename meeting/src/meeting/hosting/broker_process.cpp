// SPDX-License-Identifier: Apache-2.0
#include "meeting/hosting/broker_process.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <string_view>
#include <system_error>
#include <utility>

#include "meeting/hosting/child_process.h"
#include "telemime/core/errors.h"
#include "telemime/streaming/send_loop.h"

namespace telemime::meeting {
namespace {

constexpr int kLongestEnd = 3000;  // ms
constexpr int kTick = 20;
constexpr std::size_t kMostOutput = 2000;  // bytes

std::string ending_of(int status) {
  if (WIFSIGNALED(status)) {
    return "signal " + std::to_string(WTERMSIG(status));
  }
  return "code " + std::to_string(WEXITSTATUS(status));
}

/// The last line of a program's output that is not a warning, without the time that Mosquitto writes before
/// it (s and ": ").
std::string last_line(std::string_view output) {
  while (!output.empty()) {
    output = output.substr(0, output.find_last_not_of(" \r\n") + 1);
    const std::size_t start = output.rfind('\n') + 1;  // 0 if there is none
    std::string_view line = output.substr(start);
    output = output.substr(0, start);
    const std::size_t digits = line.find_first_not_of("0123456789");
    if (digits != 0 && digits != std::string_view::npos && line.substr(digits).starts_with(": ")) {
      line.remove_prefix(digits + 2);
    }
    if (!line.empty() && !line.starts_with("Warning: ")) {
      return std::string(line);
    }
  }
  return {};
}

}  // namespace

BrokerProcess::BrokerProcess(std::filesystem::path program, std::filesystem::path configuration,
                             Report report)
    : program_(std::move(program)), configuration_(std::move(configuration)), report_(std::move(report)) {
  wake_ = ::eventfd(0, EFD_CLOEXEC);
  if (wake_ < 0) {
    throw Error(ErrorKind::output,
                "the broker cannot be supervised: " + std::generic_category().message(errno));
  }
  thread_ = std::thread([this] { work(); });
}

BrokerProcess::~BrokerProcess() {
  const std::uint64_t one = 1;
  [[maybe_unused]] const ssize_t written = ::write(wake_, &one, sizeof one);
  thread_.join();
  ::close(wake_);
}

// The system kills the child when this thread ends.
void BrokerProcess::work() {
  RetryPauses pauses;
  std::string reported;
  for (;;) {
    const auto begun = std::chrono::steady_clock::now();
    std::string reason;
    try {
      start();
      watch();
      reason = end_of_run();
    } catch (const Error& e) {
      reason = e.what();
    }
    bool restart = false;
    {
      const std::lock_guard lock(mutex_);
      if (const std::string line = last_line(text_); !line.empty()) {
        reason += ": " + line;
      }
      ending_ = reason;
      running_ = false;
      restart = restart_;
    }
    if (wait(0)) {
      return;
    }
    if (!restart) {
      if (wait(-1)) {
        return;
      }
      continue;
    }
    const auto worked = std::chrono::steady_clock::now() - begun;
    if (worked >= RetryPauses::kGood) {
      reported.clear();
    }
    if (reason != reported) {  // one that cannot start would repeat it forever
      report_("the broker ended (" + reason + "); restarting it");
      reported = reason;
    }
    if (wait(static_cast<int>(pauses.next(worked).count()))) {
      return;
    }
  }
}

void BrokerProcess::start() {
  {
    const std::lock_guard lock(mutex_);
    text_.clear();
  }
  const ChildProcess child = start_child({program_.string(), "-c", configuration_.string()});
  const std::lock_guard lock(mutex_);
  process_ = child.id;
  output_ = child.output;
  end_ = static_cast<int>(::syscall(SYS_pidfd_open, child.id, 0));
  ++runs_;
  running_ = true;
}

// Returns when the program has ended or this object is destroyed. A closed output is not the end.
void BrokerProcess::watch() {
  std::array<char, 1024> text{};
  int output = output_;  // -1: closed; poll() ignores it
  while (output >= 0 || end_ >= 0) {
    std::array<pollfd, 3> entries{{{output, POLLIN, 0}, {wake_, POLLIN, 0}, {end_, POLLIN, 0}}};
    if (::poll(entries.data(), entries.size(), -1) < 0 && errno != EINTR) {
      return;
    }
    if (entries[1].revents != 0) {
      stop_child();
      return;
    }
    if (entries[0].revents != 0) {
      const ssize_t size = ::read(output_, text.data(), text.size());
      if (size == 0 || (size < 0 && errno != EINTR)) {
        output = -1;
      }
      append_output(text.data(), static_cast<std::size_t>(std::max<ssize_t>(size, 0)));
    } else if (entries[2].revents != 0) {
      return;  // and all of its output is read
    }
  }
}

void BrokerProcess::append_output(const char* text, std::size_t size) {
  const std::lock_guard lock(mutex_);
  text_.append(text, size);
  text_.erase(0, text_.size() > kMostOutput ? text_.size() - kMostOutput : 0);
}

// The process id stays valid until waitpid(); signal() must not use it afterwards.
std::string BrokerProcess::end_of_run() {
  siginfo_t about{};
  while (::waitid(P_PID, static_cast<id_t>(process_), &about, WEXITED | WNOWAIT) < 0 && errno == EINTR) {
  }
  const std::lock_guard lock(mutex_);
  int status = 0;
  while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
  }
  process_ = -1;
  for (int* const descriptor : {&output_, &end_}) {
    if (*descriptor >= 0) {
      ::close(std::exchange(*descriptor, -1));
    }
  }
  return ending_of(status);
}

// Before waitpid(), so that the process id is still valid.
void BrokerProcess::stop_child() const {
  ::kill(process_, SIGTERM);
  siginfo_t about{};
  for (int waited = 0; waited < kLongestEnd; waited += kTick) {
    about.si_pid = 0;
    if (::waitid(P_PID, static_cast<id_t>(process_), &about, WEXITED | WNOHANG | WNOWAIT) != 0 ||
        about.si_pid != 0) {
      return;
    }
    ::poll(nullptr, 0, kTick);
  }
  ::kill(process_, SIGKILL);
}

/// Returns true when the thread should end.
bool BrokerProcess::wait(int milliseconds) const {
  pollfd entry{wake_, POLLIN, 0};
  return ::poll(&entry, 1, milliseconds) > 0;
}

void BrokerProcess::keep_running() {
  const std::lock_guard lock(mutex_);
  restart_ = true;
}

std::uint64_t BrokerProcess::run() const {
  const std::lock_guard lock(mutex_);
  return running_ ? std::max<std::uint64_t>(runs_, 1) : 0;
}

bool BrokerProcess::signal(std::uint64_t run, int number) const {
  const std::lock_guard lock(mutex_);
  return process_ > 0 && runs_ == run && ::kill(process_, number) == 0;
}

pid_t BrokerProcess::process() const {
  const std::lock_guard lock(mutex_);
  return process_;
}

std::string BrokerProcess::last_output() const {
  const std::lock_guard lock(mutex_);
  return text_;
}

std::string BrokerProcess::ending() const {
  const std::lock_guard lock(mutex_);
  return running_ ? "" : ending_;
}

std::filesystem::path find_mosquitto(const std::string& given, const char* path) {
  const auto runs = [](const std::filesystem::path& file) {
    std::error_code hidden;  // in a folder that this user may not enter
    return std::filesystem::is_regular_file(file, hidden) && ::access(file.c_str(), X_OK) == 0;
  };
  if (!given.empty()) {
    if (!runs(given)) {
      throw Error(ErrorKind::usage, given + " is not an executable program",
                  "--mosquitto FILE is the path of the Mosquitto broker.");
    }
    return std::filesystem::absolute(given);
  }
  std::string_view rest(path == nullptr ? "" : path);
  const std::string all = std::string(rest) + ":/usr/sbin:/usr/local/sbin";
  rest = all;
  while (!rest.empty()) {
    const std::string_view folder = rest.substr(0, rest.find(':'));
    rest.remove_prefix(std::min(rest.size(), folder.size() + 1));
    std::filesystem::path file = std::filesystem::path(folder) / "mosquitto";
    if (file.is_absolute() && runs(file)) {
      return file;
    }
  }
  throw Error(ErrorKind::usage, "a meeting needs the Mosquitto broker, which is not installed",
              "On Debian: apt install mosquitto. --mosquitto FILE is its path.");
}

}  // namespace telemime::meeting
