// SPDX-License-Identifier: Apache-2.0
#include "meeting/hosting/child_process.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <initializer_list>
#include <system_error>

#include "telemime/core/errors.h"

namespace telemime::meeting {
namespace {

constexpr int kNotStarted = 127;

/// Between fork and exec: calls only async-signal-safe functions, because other threads exist.
[[noreturn]] void become(char* const* arguments, int output, int empty_input, pid_t parent) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) {
    ::_exit(kNotStarted);  // the parent ended before
  }
  sigset_t none{};
  ::sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) {
    ::signal(number, SIG_DFL);
  }
  ::dup2(empty_input, STDIN_FILENO);
  ::dup2(output, STDOUT_FILENO);
  ::dup2(output, STDERR_FILENO);
  ::close_range(STDERR_FILENO + 1, ~0U, 0);
  ::execv(arguments[0], arguments);
  // The only async-signal-safe function for the name of an error (signal-safety(7)).
  const char* const why = ::strerrordesc_np(errno);
  for (const char* const part : std::initializer_list<const char*>{
           arguments[0], " cannot be started: ", why == nullptr ? "" : why, "\n"}) {
    [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, part, std::strlen(part));
  }
  ::_exit(kNotStarted);
}

[[noreturn]] void fail(const std::string& program) {
  throw Error(ErrorKind::output, program + " cannot be started: " + std::generic_category().message(errno));
}

}  // namespace

ChildProcess start_child(const std::vector<std::string>& arguments) {
  std::vector<char*> pointers;
  pointers.reserve(arguments.size() + 1);
  for (const std::string& word : arguments) {
    pointers.push_back(const_cast<char*>(word.c_str()));
  }
  pointers.push_back(nullptr);
  std::array<int, 2> pipe{};
  if (::pipe2(pipe.data(), O_CLOEXEC) != 0) {
    fail(arguments[0]);
  }
  const int empty_input = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  const pid_t parent = ::getpid();
  const pid_t child = empty_input < 0 ? -1 : ::fork();
  if (child == 0) {
    become(pointers.data(), pipe[1], empty_input, parent);
  }
  const int error = errno;
  ::close(pipe[1]);
  if (empty_input >= 0) {
    ::close(empty_input);
  }
  if (child < 0) {
    ::close(pipe[0]);
    errno = error;
    fail(arguments[0]);
  }
  return {child, pipe[0]};
}

}  // namespace telemime::meeting
