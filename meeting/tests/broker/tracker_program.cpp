// SPDX-License-Identifier: Apache-2.0
// A tracker as a process of its own, for tests that kill it, cut it off or move its wall clock: rooms_tracker
// URL. It takes part until it is killed. SIGUSR1 moves its wall clock an hour ahead, SIGUSR2 an hour back; it
// writes a line when it has seen that.
#include <signal.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <iostream>
#include <thread>

#include "feeder.h"
#include "meeting/transport/senders.h"

namespace {

constexpr int kHour = 3600;             // s
constexpr double kLeastJump = 60.0;     // s; a clock that is set right moves by less
volatile sig_atomic_t wall_offset = 0;  // s

void an_hour_ahead(int /*signal*/) {
  wall_offset = wall_offset + kHour;
}
void an_hour_back(int /*signal*/) {
  wall_offset = wall_offset - kHour;
}

double wall_minus_steady() {
  const std::chrono::duration<double> wall = std::chrono::system_clock::now().time_since_epoch();
  const std::chrono::duration<double> steady = std::chrono::steady_clock::now().time_since_epoch();
  return wall.count() - steady.count();
}

}  // namespace

// In the place of the C library's, for all that is in this program. The monotonic clocks stay as they are.
extern "C" int clock_gettime(clockid_t clock, struct timespec* out) noexcept {
  const auto result = static_cast<int>(::syscall(SYS_clock_gettime, clock, out));
  if (result == 0 && (clock == CLOCK_REALTIME || clock == CLOCK_REALTIME_COARSE)) {
    out->tv_sec += wall_offset;
  }
  return result;
}
extern "C" int gettimeofday(struct timeval* out, void* zone) noexcept {
  const auto result = static_cast<int>(::syscall(SYS_gettimeofday, out, zone));
  out->tv_sec += wall_offset;
  return result;
}
extern "C" time_t time(time_t* out) noexcept {
  struct timeval now {};
  ::gettimeofday(&now, nullptr);
  if (out != nullptr) {
    *out = now.tv_sec;
  }
  return now.tv_sec;
}

int main(int count, char** text) {
  if (count != 2) {
    std::cerr << "rooms_tracker URL\n";
    return 2;
  }
  ::signal(SIGUSR1, an_hour_ahead);
  ::signal(SIGUSR2, an_hour_back);
  const auto sender = telemime::make_sender(text[1], telemime::meeting::kAllSenderKinds);
  const telemime::meeting::test_support::Feeder feeder(*sender);
  for (double before = wall_minus_steady();;) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    const double now = wall_minus_steady();
    if (std::abs(now - before) > kLeastJump) {
      std::cout << "the wall clock jumped by " << std::lround(now - before) << " s" << std::endl;
      before = now;
    }
  }
}
