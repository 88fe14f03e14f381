// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace telemime::meeting {

/// A running program and a pipe from its standard output and error.
struct ChildProcess {
  pid_t id = -1;
  int output = -1;  ///< ends when the program has ended or closed both
};

/// Starts a program with these arguments. It has no input, inherits no files, and is not in the foreground
/// group of the terminal, so that Ctrl-C does not reach it. The system kills it when the calling thread ends.
/// Throws Error(output); a program that cannot be executed writes the reason to its output and ends with code
/// 127.
ChildProcess start_child(const std::vector<std::string>& arguments);

}  // namespace telemime::meeting
