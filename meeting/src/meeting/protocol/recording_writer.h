// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>

#include "meeting/protocol/recording_file.h"

namespace telemime::meeting {

/// Appends bytes; throws when that fails. An empty string asks for everything to be synchronised with the
/// disk.
using WriteBytes = std::function<void(std::string_view)>;

/// Writes to a new file that only its owner may read. A failed append is undone; earlier ones stay. Data
/// reaches the disk within 20 s. Throws Error(output) when the file exists already or cannot be created.
WriteBytes new_recording_file(const std::filesystem::path& file);

/// Maximum size of the messages that wait for the disk, bytes.
inline constexpr std::size_t kWriterQueueBytes = std::size_t{8} * 1024 * 1024;

/// Writes a recording in its own thread, so that add() never waits for the disk. Poses are dropped when more
/// than half of kWriterQueueBytes waits, other messages when all of it does; a MessagesDropped records the
/// number.
class RecordingWriter {
 public:
  /// Writes the first record at once. Throws like `write` and RecordingEncoder::begin().
  RecordingWriter(WriteBytes write, const RecordingStart& start);
  RecordingWriter(const RecordingWriter&) = delete;
  RecordingWriter& operator=(const RecordingWriter&) = delete;
  /// Waits until everything is written.
  ~RecordingWriter();

  /// Adds a record other than a start. Times must not decrease.
  void add(Record record);
  /// Closes the recording and waits until everything is written. Throws Error(output) when anything could not
  /// be written.
  void end(std::uint64_t at);
  /// Why nothing more can be written.
  std::optional<std::string> failure() const;
  std::uint64_t bytes() const;
  std::uint64_t messages() const;
  std::uint64_t dropped() const;

 private:
  void run();
  std::string encoded(std::deque<Record>& records);
  void finish();

  WriteBytes write_;  ///< used by the thread only
  RecordingEncoder encoder_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Record> queue_;
  std::size_t waiting_ = 0;    ///< bytes in the queue and being written
  std::uint32_t missing_ = 0;  ///< dropped, not yet recorded
  std::uint64_t bytes_ = 0;
  std::uint64_t messages_ = 0;
  std::uint64_t dropped_ = 0;
  bool closed_ = false;
  std::optional<std::string> failure_;
  std::thread thread_;
};

}  // namespace telemime::meeting
