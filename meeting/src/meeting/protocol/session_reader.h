// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include "meeting/protocol/session_file.h"
#include "meeting/protocol/session_summary.h"

namespace telemime {

/// A recording's file, read from its beginning, in memory that does not grow with it.
class SessionReader {
 public:
  /// Throws Error(input) for what cannot be opened and is no recording of a version that is known.
  explicit SessionReader(std::filesystem::path file);
  /// The next record, the start first; nothing at the end of what can be read. Throws Error(input) where the
  /// file cannot be read.
  std::optional<SessionRecord> next();
  /// Once there is nothing more: what is wrong with the end, in words; empty when it ended in order.
  std::string complaint() const;

 private:
  std::filesystem::path file_;
  std::ifstream in_;
  SessionDecoder decoder_;
  std::uint64_t size_ = 0;  ///< bytes that were read
  std::optional<SessionRecord> start_;
};

/// What a recording holds, and what is wrong with it.
struct SessionLook {
  SessionSummary summary;
  std::string complaint;  ///< as SessionReader::complaint
};

/// Reads the whole file. Throws as SessionReader does.
SessionLook look_at_session(const std::filesystem::path& file);

}  // namespace telemime
