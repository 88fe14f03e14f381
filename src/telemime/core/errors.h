// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>

namespace telemime {

/// What went wrong, by whom it can be mended. The program maps each to its exit code (docs/cli.md).
enum class ErrorKind {
  usage,     ///< wrong option or argument
  config,    ///< a configuration, limits, camera or calibration file that cannot be used
  input,     ///< a video, image or pose file that cannot be read
  output,    ///< a result that cannot be written (permission, full disk)
  tracking,  ///< the input was read, but nothing could be tracked in it
};

/// Misuse or set-up failure. The message names the cause and what to do about it, in plain words.
class Error : public std::runtime_error {
 public:
  Error(ErrorKind kind, const std::string& cause, const std::string& remedy = {})
      : std::runtime_error(remedy.empty() ? cause : cause + "\n  " + remedy), kind_(kind) {}
  ErrorKind kind() const { return kind_; }

 private:
  ErrorKind kind_;
};

}  // namespace telemime
