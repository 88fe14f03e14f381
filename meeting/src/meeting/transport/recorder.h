// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "meeting/protocol/recording_writer.h"
#include "meeting/transport/login.h"

namespace telemime::meeting {

/// Records all messages of a meeting until `stop` returns true or the file cannot be written. Connects again
/// when the connection is lost; the gap is marked in the recording and reported.
class MeetingRecorder {
 public:
  using Report = std::function<void(const std::string& text)>;

  MeetingRecorder(MeetingLogin& login, std::function<bool()> stop, Report report);

  /// Logs in. Throws Error(input) when that fails.
  const BrokerLogin& log_in();
  /// Records from now on; the times start at 0. Returns the time of the end, us; the caller writes the end.
  /// Throws Error(input) when the first connection fails, and Error(usage) like MqttConnection.
  std::uint64_t record(RecordingWriter& writer);

 private:
  bool attempt(RecordingWriter& writer);
  std::uint64_t now() const;

  MeetingLogin& way_;
  const std::function<bool()> stop_;
  const Report report_;
  BrokerLogin login_;
  std::int64_t began_ = 0;  ///< us of the steady clock
  bool connected_before_ = false;
  bool lost_ = false;
};

}  // namespace telemime::meeting
