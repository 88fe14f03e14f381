// SPDX-License-Identifier: Apache-2.0
#include "open_page.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <system_error>
#include <thread>

#include "telemime/core/errors.h"

namespace telemime {
namespace {

constexpr const char* kOpener = "xdg-open";

bool has_display() {
  const auto set = [](const char* name) {
    const char* const value = std::getenv(name);
    return value != nullptr && *value != '\0';
  };
  return set("DISPLAY") || set("WAYLAND_DISPLAY");
}

// Returns 0 or the error number. The new process keeps nothing of this program: neither the terminal's Ctrl-C
// nor the camera nor the server's port.
int start_opener(std::string url) {
  int failure = 0;
  const auto check = [&failure](int error_number) { failure = failure != 0 ? failure : error_number; };
  posix_spawnattr_t attributes;
  check(::posix_spawnattr_init(&attributes));
  check(::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSID | POSIX_SPAWN_SETSIGDEF));
  sigset_t ignored_here;
  ::sigemptyset(&ignored_here);
  ::sigaddset(&ignored_here, SIGPIPE);
  check(::posix_spawnattr_setsigdefault(&attributes, &ignored_here));
  posix_spawn_file_actions_t actions;
  check(::posix_spawn_file_actions_init(&actions));
  for (const int standard : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    check(::posix_spawn_file_actions_addopen(&actions, standard, "/dev/null", O_RDWR, 0));
  }
  check(::posix_spawn_file_actions_addclosefrom_np(&actions, STDERR_FILENO + 1));
  // No shell parses the address: it is one argument, whatever it contains.
  std::string name = kOpener;
  const std::array<char*, 3> arguments = {name.data(), url.data(), nullptr};
  pid_t opener = 0;
  if (failure == 0) {
    failure = ::posix_spawnp(&opener, kOpener, &actions, &attributes, arguments.data(), environ);
  }
  ::posix_spawn_file_actions_destroy(&actions);
  ::posix_spawnattr_destroy(&attributes);
  if (failure != 0) {
    return failure;
  }
  // It may run as long as the browser does. A thread waits for its end, so that it does not become a zombie.
  try {
    std::thread([opener] {
      while (::waitpid(opener, nullptr, 0) < 0 && errno == EINTR) {
      }
    }).detach();
  } catch (const std::system_error&) {  // NOLINT(bugprone-empty-catch): a zombie until this program ends
  }
  return 0;
}

}  // namespace

void open_page(const std::string& url) {
  if (!has_display()) {
    throw Error(ErrorKind::output, "there is no display to open a browser on",
                "Open " + url + " yourself; from another computer that needs --address.");
  }
  if (const int why = start_opener(url); why != 0) {
    throw Error(ErrorKind::output,
                std::string("the browser could not be opened: ") + kOpener +
                    " does not start: " + std::generic_category().message(why),
                "Install the package xdg-utils, or open " + url + " yourself.");
  }
}

}  // namespace telemime
