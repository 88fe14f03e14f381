// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <exception>
#include <string_view>
#include <utility>

#include "telemime/core/errors.h"

namespace telemime {

/// Exit codes of the program (docs/cli.md).
inline constexpr int kExitInternal = 1;
inline constexpr int kExitUsage = 2;
inline constexpr int kExitConfig = 3;
inline constexpr int kExitInput = 4;
inline constexpr int kExitOutput = 5;
inline constexpr int kExitTracking = 6;
inline constexpr int kExitInterrupted = 130;

/// What they mean, as the manual page says it.
inline constexpr std::array<std::pair<int, std::string_view>, 8> kExitMeanings = {{
    {0, "success"},
    {kExitInternal, "unexpected failure"},
    {kExitUsage, "invalid option or argument"},
    {kExitConfig,
     "a configuration, limits, camera or calibration file cannot be used; doctor: there is a problem"},
    {kExitInput, "the input cannot be read"},
    {kExitOutput, "results cannot be written"},
    {kExitTracking, "no person was tracked"},
    {kExitInterrupted,
     "interrupted by Ctrl-C (not live, for which this is the usual end); everything written is valid"},
}};

inline int exit_code(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::usage:
      return kExitUsage;
    case ErrorKind::config:
      return kExitConfig;
    case ErrorKind::input:
      return kExitInput;
    case ErrorKind::output:
      return kExitOutput;
    case ErrorKind::tracking:
      return kExitTracking;
  }
  return kExitInternal;
}

/// The user pressed Ctrl-C; everything written so far is valid.
class Interrupted : public std::exception {};

/// The run failed, and the user has been told why.
class ToldAlready : public std::exception {
 public:
  explicit ToldAlready(int code) : code_(code) {}
  int code() const { return code_; }

 private:
  int code_;
};

}  // namespace telemime
