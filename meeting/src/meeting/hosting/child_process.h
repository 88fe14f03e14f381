// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace telemime::meeting {

/// A program that was started, with a pipe from its standard output and error.
struct ChildProcess {
  pid_t id = -1;
  int output = -1;  ///< its end: the program has ended, or closed both
};

/// Starts a program with these words. It has no input, none of our files, and is no part of the terminal's
/// foreground (Ctrl-C is ours). The system kills it when the calling thread ends: that must be one that lives
/// as long as the child shall. Throws Error(output); what cannot be executed says so by its output and ends
/// with 127.
ChildProcess start_child(const std::vector<std::string>& words);

}  // namespace telemime::meeting
