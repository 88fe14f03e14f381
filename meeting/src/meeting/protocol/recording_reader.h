// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include "meeting/protocol/recording_file.h"
#include "meeting/protocol/recording_summary.h"

namespace telemime::meeting {

/// A recording's file, read from its beginning, in memory that does not grow with it.
class RecordingReader {
 public:
  /// Throws Error(input) for what cannot be opened and is no recording of a version that is known.
  explicit RecordingReader(std::filesystem::path file);
  /// The next record, the start first; nothing at the end of what can be read. Throws Error(input) where the
  /// file cannot be read.
  std::optional<Record> next();
  /// Once there is nothing more: what is wrong with the end, in words; empty when it ended in order.
  std::string complaint() const;

 private:
  std::filesystem::path file_;
  std::ifstream in_;
  RecordingDecoder decoder_;
  std::uint64_t size_ = 0;  ///< bytes that were read
  std::optional<Record> start_;
};

/// What a recording holds, and what is wrong with it.
struct RecordingReport {
  RecordingSummary summary;
  std::string complaint;  ///< as RecordingReader::complaint
};

/// Reads the whole file. Throws as RecordingReader does.
RecordingReport inspect_recording(const std::filesystem::path& file);

}  // namespace telemime::meeting
