// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "meeting/protocol/recording_writer.h"
#include "meeting/transport/login.h"

namespace telemime::meeting {

/// Hears all that is said in a room and has it written, until `stop` holds, or the file cannot be written. A
/// connection that is lost is made again, and the gap is told in the recording and by `say`, in words.
class MeetingRecorder {
 public:
  using Say = std::function<void(const std::string& words)>;

  MeetingRecorder(MeetingLogin& door, std::function<bool()> stop, Say say);

  /// Comes in. Throws Error(input) in words when that fails.
  const BrokerLogin& log_in();
  /// Records from now on; the times count from here. Returns the time of the end, us, which is left to the
  /// caller to be written. Throws Error(input) when the room cannot be heard at first, Error(usage) as
  /// MqttConnection does.
  std::uint64_t record(RecordingWriter& writer);

 private:
  bool attempt(RecordingWriter& writer);
  void hear(RecordingWriter& writer, const MqttMessage& message) const;
  std::uint64_t now() const;

  MeetingLogin& door_;
  const std::function<bool()> stop_;
  const Say say_;
  BrokerLogin login_;
  std::int64_t began_ = 0;  ///< us of the steady clock
  bool heard_ever_ = false;
  bool lost_ = false;
};

}  // namespace telemime::meeting
