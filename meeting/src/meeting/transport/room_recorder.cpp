// SPDX-License-Identifier: Apache-2.0
#include "meeting/transport/room_recorder.h"

#include <chrono>
#include <utility>

#include "meeting/transport/mqtt_names.h"
#include "meeting/transport/plain_loop.h"
#include "telemime/core/errors.h"

namespace telemime {
namespace {

using SteadyClock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kForever = std::chrono::hours(1);
/// A connection that stood this long was a good one: the next failure is a new one.
constexpr std::chrono::seconds kGoodConnection{2};

std::int64_t steady_us() {
  return std::chrono::duration_cast<std::chrono::microseconds>(SteadyClock::now().time_since_epoch()).count();
}

}  // namespace

RoomRecorder::RoomRecorder(RoomDoor& door, std::function<bool()> stop, Say say)
    : door_(door), stop_(std::move(stop)), say_(std::move(say)), began_(steady_us()) {}

const RoomLogin& RoomRecorder::come_in() {
  login_ = door_.come_in();
  return login_;
}

std::uint64_t RoomRecorder::now() const {
  return static_cast<std::uint64_t>(steady_us() - began_);
}

void RoomRecorder::hear(SessionWriter& writer, const MqttMessage& message) const {
  if (auto topic = read_topic(login_.room, message.topic)) {
    writer.add(SessionMessage{now(), std::move(*topic), message.payload});
  }
}

std::uint64_t RoomRecorder::record(SessionWriter& writer) {
  began_ = steady_us();
  PlainLoop pauses([&] { return stop_() || writer.failure(); });
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
          come_in();
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
bool RoomRecorder::attempt(SessionWriter& writer) {
  PlainLoop loop([&] { return stop_() || writer.failure(); });
  MqttConnection connection(loop, login_.server, [&](const MqttMessage& message) { hear(writer, message); });
  try {
    connection.open(any_client_id("record"), std::nullopt);
    if (std::exchange(lost_, false)) {
      writer.add(SessionBack{now()});
      say_("the room is heard again");
    }
    connection.subscribe(room_filter(login_.room));
    heard_ever_ = true;
    for (;;) {
      loop.wait([] { return false; }, kForever);
    }
  } catch (const LinkBroken& e) {
    if (!heard_ever_) {
      throw Error(ErrorKind::input, "the room at " + door_.shown() + " cannot be heard: " + e.what());
    }
    if (!lost_) {
      writer.add(SessionLost{now(), e.what()});
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

}  // namespace telemime
