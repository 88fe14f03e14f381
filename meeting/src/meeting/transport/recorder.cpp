// SPDX-License-Identifier: Apache-2.0
#include "meeting/transport/recorder.h"

#include <chrono>
#include <utility>

#include "meeting/transport/blocking_loop.h"
#include "meeting/transport/mqtt_names.h"
#include "telemime/core/errors.h"

namespace telemime::meeting {
namespace {

using SteadyClock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kForever = std::chrono::hours(1);
/// A connection that stood this long was a good one: the next failure is a new one.
constexpr std::chrono::seconds kGoodConnection{2};

std::int64_t steady_us() {
  return std::chrono::duration_cast<std::chrono::microseconds>(SteadyClock::now().time_since_epoch()).count();
}

}  // namespace

MeetingRecorder::MeetingRecorder(MeetingLogin& door, std::function<bool()> stop, Say say)
    : door_(door), stop_(std::move(stop)), say_(std::move(say)), began_(steady_us()) {}

const BrokerLogin& MeetingRecorder::log_in() {
  login_ = door_.log_in();
  return login_;
}

std::uint64_t MeetingRecorder::now() const {
  return static_cast<std::uint64_t>(steady_us() - began_);
}

void MeetingRecorder::hear(RecordingWriter& writer, const MqttMessage& message) const {
  if (auto topic = read_topic(login_.meeting, message.topic)) {
    writer.add(RecordedMessage{now(), std::move(*topic), message.payload});
  }
}

std::uint64_t MeetingRecorder::record(RecordingWriter& writer) {
  began_ = steady_us();
  BlockingLoop pauses([&] { return stop_() || writer.failure(); });
  RetryPauses pause;
  try {
    while (!stop_()) {
      const auto start = SteadyClock::now();
      if (!attempt(writer)) {
        break;
      }
      if (SteadyClock::now() - start >= kGoodConnection) {
        pause.reset();
      }
      pauses.wait([] { return false; }, pause.next());
      if (door_.is_link()) {  // a room that was opened anew has new accounts
        try {
          log_in();
        } catch (const Error&) {  // the account that is known may do
          continue;
        }
      }
    }
  } catch (const LoopStopped&) {
    return now();
  }
  return now();
}

// Until the connection is lost (true) or the recording is over (false).
bool MeetingRecorder::attempt(RecordingWriter& writer) {
  BlockingLoop loop([&] { return stop_() || writer.failure(); });
  MqttConnection connection(loop, login_.server, [&](const MqttMessage& message) { hear(writer, message); });
  try {
    connection.open(any_client_id("record"), std::nullopt);
    if (std::exchange(lost_, false)) {
      writer.add(ConnectionRestored{now()});
      say_("the room is heard again");
    }
    connection.subscribe(meeting_filter(login_.meeting));
    heard_ever_ = true;
    for (;;) {
      loop.wait([] { return false; }, kForever);
    }
  } catch (const LinkBroken& e) {
    if (!heard_ever_) {
      throw Error(ErrorKind::input, "the room at " + door_.shown() + " cannot be heard: " + e.what());
    }
    if (!lost_) {
      writer.add(ConnectionLost{now(), e.what()});
      say_(std::string("the room is not heard any more: ") + e.what() + "; trying again");
    }
    lost_ = true;
    connection.close();
    return true;
  } catch (const LoopStopped&) {
    connection.goodbye({});
    return false;
  }
}

}  // namespace telemime::meeting
