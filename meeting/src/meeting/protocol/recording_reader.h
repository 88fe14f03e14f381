// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "meeting/protocol/recording_file.h"

namespace telemime::meeting {

/// Reads the file of a recording from its beginning. Its memory does not grow with the file.
class RecordingReader {
 public:
  /// Throws Error(input) for a file that cannot be opened or is not a recording of a known version.
  explicit RecordingReader(std::filesystem::path file);
  /// The next record, the start first; nothing at the end of what can be read. Throws Error(input) when
  /// reading fails.
  std::optional<Record> next();
  /// After the last record: what is wrong with the end of the file; empty when it was closed properly.
  std::string complaint() const;

 private:
  std::filesystem::path file_;
  std::ifstream in_;
  RecordingDecoder decoder_;
  std::uint64_t size_ = 0;  ///< bytes read
  std::optional<Record> start_;
};

/// What a recording contains of one participant.
struct RecordedParticipant {
  std::set<std::string> names;  ///< in their valid states
  std::uint64_t frames = 0;
  std::uint64_t others = 0;  ///< messages that are not frames
  bool takes_part = false;   ///< was present or sent something: there is something to replay
};

/// What a recording contains.
struct RecordingSummary {
  RecordingStart start;
  std::map<std::string, RecordedParticipant> people;  ///< by participant
  std::uint64_t end = 0;                              ///< us
  std::size_t gaps = 0;                               ///< interruptions of the connection
  std::uint64_t dropped = 0;                          ///< messages

  void add(const Record& record);
};

/// Whether `wanted` contains the participant or one of their names. An empty set contains everyone.
bool is_wanted(const std::string& participant, const RecordedParticipant& person,
               const std::set<std::string>& wanted);

/// What a recording contains, and what is wrong with its end (RecordingReader::complaint).
struct RecordingReport {
  RecordingSummary summary;
  std::string complaint;
};

/// Reads the whole file. Throws like RecordingReader.
RecordingReport inspect_recording(const std::filesystem::path& file);

}  // namespace telemime::meeting
