// SPDX-License-Identifier: Apache-2.0
#include "open_page.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <system_error>

#include "telemime/core/errors.h"

namespace telemime {
namespace {

constexpr const char* kOpener = "xdg-open";
constexpr int kMostDescriptors = 65536;

bool has_display() {
  const auto set = [](const char* name) {
    const char* const value = std::getenv(name);
    return value != nullptr && *value != '\0';
  };
  return set("DISPLAY") || set("WAYLAND_DISPLAY");
}

// Ends the new process after reporting the reason to the parent.
[[noreturn]] void give_up(int report, int why) {
  (void)!::write(report, &why, sizeof why);
  ::_exit(127);
}

// Runs in the new process, where only system calls are safe. It keeps nothing of this program: neither the
// terminal's Ctrl-C nor the camera nor the server's port.
[[noreturn]] void become_opener(const char* url, int report) {
  ::setsid();
  const pid_t opener = ::fork();
  if (opener < 0) {
    give_up(report, errno);
  }
  if (opener > 0) {
    ::_exit(0);  // the parent need not wait for the browser
  }
  const int nowhere = ::open("/dev/null", O_RDWR);
  for (const int standard : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    ::dup2(nowhere, standard);
  }
  for (int other = STDERR_FILENO + 1; other < kMostDescriptors; ++other) {
    if (other != report) {
      ::close(other);
    }
  }
  // No shell parses the address: it is one argument, whatever it contains.
  ::signal(SIGPIPE, SIG_DFL);
  ::execlp(kOpener, kOpener, url, static_cast<char*>(nullptr));
  give_up(report, errno);
}

}  // namespace

void open_page(const std::string& url) {
  if (!has_display()) {
    throw Error(ErrorKind::output, "there is no display to open a browser on",
                "Open " + url + " yourself; from another computer that needs --address.");
  }
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) {
    throw Error(ErrorKind::output, "the browser could not be started", "Open " + url + " yourself.");
  }
  const pid_t child = ::fork();
  if (child == 0) {
    become_opener(url.c_str(), ends[1]);
  }
  int why = child < 0 ? errno : 0;
  ::close(ends[1]);
  if (child > 0) {
    while (::waitpid(child, nullptr, 0) < 0 && errno == EINTR) {
    }
    // The pipe closes when xdg-open starts; otherwise it reports the reason.
    ssize_t count = 0;
    do {
      count = ::read(ends[0], &why, sizeof why);
    } while (count < 0 && errno == EINTR);
    why = count == static_cast<ssize_t>(sizeof why) ? why : 0;
  }
  ::close(ends[0]);
  if (why != 0) {
    throw Error(ErrorKind::output,
                std::string("the browser could not be opened: ") + kOpener +
                    " does not start: " + std::generic_category().message(why),
                "Install the package xdg-utils, or open " + url + " yourself.");
  }
}

}  // namespace telemime
