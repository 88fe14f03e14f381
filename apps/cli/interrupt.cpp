// SPDX-License-Identifier: Apache-2.0
#include "cli/interrupt.h"

#include <unistd.h>

#include <csignal>

namespace telemime {
namespace {

// A signal handler can access nothing else.
volatile std::sig_atomic_t interrupt_noted = 0;

void on_interrupt(int signal) {
  // A closing terminal may send the signal twice.
  if (interrupt_noted != 0 && signal != SIGHUP) {
    ::_exit(128 + signal);
  }
  interrupt_noted = 1;
}

}  // namespace

void note_interrupts() {
  // Ctrl-C also ends a program that reads what this one prints: what was begun is still finished.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGINT, on_interrupt);
  std::signal(SIGTERM, on_interrupt);
  if (std::signal(SIGHUP, on_interrupt) == SIG_IGN) {
    std::signal(SIGHUP, SIG_IGN);
  }
}

bool interrupted() {
  return interrupt_noted != 0;
}

}  // namespace telemime
