// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "telemime/outputs/encoder.h"

namespace telemime {

/// Writes a stream of frames to a file. Each frame is written immediately and completely, and the frame count
/// in the head is updated after it, so that the file is valid whenever the program stops. A write that fails
/// is undone to the last complete frame.
class FileOutput {
 public:
  /// Creates or empties the file and writes the head. Throws Error(output) that names the file and the
  /// reason.
  FileOutput(const std::filesystem::path& file, std::unique_ptr<Encoder> encoder, const StreamHeader& header);
  FileOutput(const FileOutput&) = delete;
  FileOutput& operator=(const FileOutput&) = delete;
  /// Closes the file; the tail is written only by close().
  ~FileOutput();

  /// Throws Error(output) if the disk is full or gone.
  void write(const MotionFrame& frame);

  /// Writes the tail and closes. Throws Error(output). Does nothing the second time.
  void close();

  const std::filesystem::path& path() const { return path_; }

 private:
  [[noreturn]] void fail(int error_number);
  void append(std::string_view bytes);
  void patch();

  std::filesystem::path path_;
  std::unique_ptr<Encoder> encoder_;
  int descriptor_ = -1;
  std::size_t size_ = 0;   ///< bytes of complete frames
  bool seekable_ = false;  ///< a pipe cannot be patched; its frame count remains 0
};

}  // namespace telemime
