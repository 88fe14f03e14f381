// SPDX-License-Identifier: Apache-2.0
#include "meeting/transport/recorder.h"

#include <chrono>
#include <utility>

#include "telemime/core/errors.h"

namespace telemime::meeting {
namespace {

using SteadyClock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kForever = std::chrono::hours(1);

std::int64_t steady_us() {
  return std::chrono::duration_cast<std::chrono::microseconds>(SteadyClock::now().time_since_epoch()).count();
}

}  // namespace

MeetingRecorder::MeetingRecorder(MeetingLogin& login, std::function<bool()> stop, Report report)
    : way_(login), stop_(std::move(stop)), report_(std::move(report)), began_(steady_us()) {}

const BrokerLogin& MeetingRecorder::log_in() {
  login_ = way_.log_in();
  return login_;
}

std::uint64_t MeetingRecorder::now() const {
  return static_cast<std::uint64_t>(steady_us() - began_);
}

std::uint64_t MeetingRecorder::record(RecordingWriter& writer) {
  began_ = steady_us();
  SendLoop loop([&] { return stop_() || writer.failure(); });
  RetryPauses pauses;
  try {
    while (!stop_()) {
      const auto start = SteadyClock::now();
      if (!attempt(writer)) {
        break;
      }
      loop.wait([] { return false; }, pauses.next(SteadyClock::now() - start));
      if (way_.is_link()) {  // a meeting that was closed and opened again has new accounts
        try {
          log_in();
        } catch (const Error&) {  // the known account may still work
          continue;
        }
      }
    }
  } catch (const LoopStopped&) {
    return now();
  }
  return now();
}

// Returns true when the connection is lost, and false when the recording ends.
bool MeetingRecorder::attempt(RecordingWriter& writer) {
  SendLoop loop([&] { return stop_() || writer.failure(); });
  MqttConnection connection(loop, login_.server, [&](const MqttMessage& message) {
    if (auto topic = read_topic(login_.meeting, message.topic)) {
      writer.add(RecordedMessage{now(), std::move(*topic), message.payload});
    }
  });
  try {
    connection.open(random_client_id("record"), std::nullopt);
    if (std::exchange(lost_, false)) {
      writer.add(ConnectionRestored{now()});
      report_("the connection to the meeting is restored");
    }
    connection.subscribe(meeting_filter(login_.meeting));
    connected_before_ = true;
    for (;;) {
      loop.wait([] { return false; }, kForever);
    }
  } catch (const LinkBroken& e) {
    if (!connected_before_) {
      throw Error(ErrorKind::input, "the meeting at " + way_.shown() + " cannot be recorded: " + e.what());
    }
    if (!lost_) {
      writer.add(ConnectionLost{now(), e.what()});
      report_(std::string("the connection to the meeting is lost: ") + e.what() + "; trying again");
    }
    lost_ = true;
    connection.close();
    return true;
  } catch (const LoopStopped&) {
    connection.disconnect({});
    return false;
  }
}

}  // namespace telemime::meeting
