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

/// Appends bytes; throws when they cannot be written. No bytes ask that what was appended be kept for good.
using WriteBytes = std::function<void(std::string_view)>;

/// Writes to a new file that only its owner may read. When the disk is full, what was appended before stays
/// and the rest is taken back. What was written reaches the disk within 20 s, and when it is asked for.
/// Throws Error(output) when there can be no such file, also when there is one already.
WriteBytes new_recording_file(const std::filesystem::path& file);

/// Bytes of messages that wait for the disk at most.
inline constexpr std::size_t kWriterQueueBytes = std::size_t{8} * 1024 * 1024;

/// Writes a recording in a thread of its own: who adds to it never waits for the disk. When more waits than
/// half of kWriterQueueBytes, poses are dropped, when more than all, everything; a MessagesDropped says so.
class RecordingWriter {
 public:
  /// Writes the beginning at once. Throws as `write` does, and as RecordingEncoder::begin().
  RecordingWriter(WriteBytes write, const RecordingStart& start);
  RecordingWriter(const RecordingWriter&) = delete;
  RecordingWriter& operator=(const RecordingWriter&) = delete;
  /// Waits until all is written.
  ~RecordingWriter();

  /// Anything but a start, in the order of time.
  void add(Record record);
  /// Ends the recording in order and waits until all is written. Throws Error(output) when anything could not
  /// be written.
  void end(std::uint64_t at);
  /// Why nothing more can be written, in words.
  std::optional<std::string> failure() const;
  std::uint64_t bytes() const;
  std::uint64_t messages() const;
  std::uint64_t dropped() const;

 private:
  void run();
  std::string encoded(std::deque<Record>& records);
  void finish();

  WriteBytes write_;  ///< the thread's alone
  RecordingEncoder encoder_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Record> queue_;
  std::size_t waiting_ = 0;    ///< bytes in the queue, and in what is being written
  std::uint32_t missing_ = 0;  ///< dropped and not yet told in the file
  std::uint64_t bytes_ = 0;
  std::uint64_t messages_ = 0;
  std::uint64_t dropped_ = 0;
  bool over_ = false;
  std::optional<std::string> failure_;
  std::thread thread_;
};

}  // namespace telemime::meeting
