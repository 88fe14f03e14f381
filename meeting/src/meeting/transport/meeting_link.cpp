// SPDX-License-Identifier: Apache-2.0
#include "meeting/transport/meeting_link.h"

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/address.hpp>
#include <chrono>
#include <cmath>
#include <utility>

namespace telemime::meeting {
namespace {

using std::chrono::milliseconds;
using SteadyClock = std::chrono::steady_clock;

constexpr milliseconds kLongestAnswer{3000};
constexpr milliseconds kSlowWrite{1000};
constexpr milliseconds kLongestWrite{4000};  // after that
constexpr double kPromise = 1.25;            // s, the promised time between messages
constexpr double kLongestSilence = 1.0;  // s, after which presence is repeated: some time before the promise
constexpr double kShortestWait = 0.1;    // s, while the connection accepts no data
/// A page with our id gives way to a tracker. For this long after we joined, its presence may still be on its
/// way.
constexpr double kCrossing = 1.0;  // s
constexpr double kMicrosecondsPerMillisecond = 1000.0;

double seconds_now() {
  return std::chrono::duration<double>(SteadyClock::now().time_since_epoch()).count();
}

SteadyClock::time_point at_seconds(double seconds) {
  return SteadyClock::time_point(
      std::chrono::duration_cast<SteadyClock::duration>(std::chrono::duration<double>(seconds)));
}

bool is_this_computer(const std::string& host) {
  boost::system::error_code no_address;
  const auto address = boost::asio::ip::make_address(host, no_address);
  return no_address ? host == "localhost" : address.is_loopback();
}

std::uint64_t microseconds(double milliseconds_taken) {
  const double us = milliseconds_taken * kMicrosecondsPerMillisecond;
  return std::isfinite(us) && us > 0.0 ? static_cast<std::uint64_t>(std::llround(us)) : 0;
}

}  // namespace

MeetingLink::MeetingLink(SendLoop& loop, MeetingOutput output)
    : loop_(loop),
      output_(std::move(output)),
      session_(random_session()),
      pose_topic_(topic(TopicKind::pose)),
      last_messages_{presence(false), MqttMessage{topic(TopicKind::state), ""}},
      connection_(loop, output_.server, [this](const MqttMessage& message) { on_message(message); }),
      pose_timer_(loop.io()),
      presence_timer_(loop.io()) {}

std::string MeetingLink::topic(TopicKind kind) const {
  return topic_text(output_.meeting, {kind, output_.participant, 0});
}

MqttMessage MeetingLink::presence(bool here) const {
  const std::optional<double> every = here ? std::optional(kPromise) : std::nullopt;
  return {topic(TopicKind::presence), write_presence({here, session_, every})};
}

MqttMessage MeetingLink::state() const {
  ParticipantState state;
  state.session = session_;
  state.name = output_.name;
  state.seat = output_.seat;
  state.avatar = AvatarByLook{output_.look};
  if (motion_) {
    if (const double stature = motion_->body().shape.stature; is_stature(stature)) {
      state.stature = stature;
    }
    for (std::size_t bone = 0; bone < kHumanBoneCount; ++bone) {
      state.bones[bone] = motion_->skeleton().position[bone];
    }
  }
  return {topic(TopicKind::state), write_state(state)};
}

std::string MeetingLink::warnings() const {
  std::string text = output_.warning;
  const auto add = [&text](const std::string& more) { text += (text.empty() ? "" : "; ") + more; };
  if (!output_.server.ca_file && !output_.server.password.empty() && !is_this_computer(output_.server.host)) {
    add("the password is sent unencrypted; mqtts:// encrypts it");
  }
  if (duplicate_) {
    add("another client takes part as \"" + output_.participant + "\"");
  }
  return text;
}

void MeetingLink::open() {
  attendance_ = {};
  confirmed_.reset();
  duplicate_ = false;
  waiting_.reset();
  detail_pace_ = {};
  connection_.open(random_client_id(output_.participant), presence(false));
  connection_.subscribe(presence_filter(output_.meeting));
  connection_.publish_retained(presence(true));
  connection_.publish_retained(state());
  // MQTT 3.1.1 does not report a message that the broker discards. What it accepts comes back to us.
  if (!loop_.wait([this] { return confirmed_.has_value(); }, kLongestAnswer)) {
    throw LinkBroken("the account may not publish as \"" + output_.participant + "\"");
  }
  loop_.sending(warnings());
  count_participants();
  last_sent_ = seconds_now();
  repeat_presence();
}

void MeetingLink::person(const std::shared_ptr<const StreamHeader>& person) {
  if (person_ != person) {
    motion_.emplace(person->body);
    person_ = person;
    waiting_.reset();
  }
  connection_.publish_retained(state());
}

bool MeetingLink::frame(const MotionFrame& raw, double taken) {
  drain();
  const MotionFrame frame = motion_->clean(raw);
  const auto motion = (*motion_)(frame);
  waiting_.emplace();
  if (motion) {
    *waiting_ = {pose_frame_of(*motion, frame.spread), pose_detail_of(*motion, frame.face)};
  }
  waiting_->pose.captured = microseconds(taken);
  send_when_due();
  const bool sent = uncounted_ > 0;
  uncounted_ -= sent ? 1 : 0;
  return sent;
}

void MeetingLink::close() noexcept {
  boost::system::error_code ignored;
  pose_timer_.cancel(ignored);
  presence_timer_.cancel(ignored);
  waiting_.reset();
  confirmed_.reset();
  connection_.disconnect(last_messages_);
  connection_.close();
}

void MeetingLink::on_message(const MqttMessage& message) {
  const auto topic = read_topic(output_.meeting, message.topic);
  if (!topic || topic->kind != TopicKind::presence) {
    return;
  }
  attendance_.update(topic->participant, message.payload);
  if (topic->participant == output_.participant) {
    if (message.payload.empty()) {
      on_own_absence();
    } else if (const auto presence = read_presence(message.payload)) {
      on_own_presence(*presence);
    }
  }
  count_participants();
}

void MeetingLink::on_own_presence(const ParticipantPresence& presence) {
  if (!presence.here) {
    on_own_absence();
  } else if (presence.session == session_) {
    confirmed_ = confirmed_ ? confirmed_ : seconds_now();
  } else if (confirmed_ &&
             seconds_now() > *confirmed_ + kCrossing) {  // before that, it may be of an earlier run
    duplicate_ = true;
    loop_.sending(warnings());
  }
}

// The broker may have noticed only now that an older connection of ours ended, another client with our id may
// have left, or our retained messages may have been cleared.
void MeetingLink::on_own_absence() {
  if (confirmed_) {
    duplicate_ = false;
    loop_.sending(warnings());
    connection_.publish_retained(presence(true));
    connection_.publish_retained(state());
  }
}

void MeetingLink::count_participants() {
  const std::size_t others = attendance_.count() - (attendance_.has(output_.participant) ? 1 : 0);
  pace_.set_participants(others + 1);
  if (confirmed_) {
    loop_.receivers(static_cast<std::int64_t>(others));
  }
}

void MeetingLink::drain() {
  const auto done = [this] { return connection_.drained(); };
  if (!loop_.wait(done, kSlowWrite)) {
    loop_.sending("it reads too slowly; frames are dropped");
    if (!loop_.wait(done, kLongestWrite)) {
      throw LinkBroken("it does not read the data");
    }
    loop_.sending(warnings());
  }
}

void MeetingLink::send_when_due() {
  if (!waiting_) {
    return;
  }
  const double now = seconds_now();
  // While earlier data are on their way, the frame waits: it may be the last one before a pause.
  constexpr double kUntilDrained = 0.01;  // s
  const double due = connection_.drained() ? pace_.due(*waiting_) : now + kUntilDrained;
  if (due > now) {
    pose_timer_.expires_at(at_seconds(due));
    pose_timer_.async_wait([this](const boost::system::error_code& error) {
      if (!error) {
        send_when_due();
      }
    });
    return;
  }
  auto& [pose, detail] = *waiting_;
  pose.session = detail.session = session_;
  pose.sequence = detail.sequence = sequence_++;
  // The frame of a lost person may repeat the time of the previous one.
  pose.captured = captured_ = std::max(pose.captured, captured_ + 1);
  pose.still = pace_.still(*waiting_);
  const auto publish = [this](const std::vector<std::uint8_t>& bytes) {
    connection_.publish(pose_topic_, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  };
  publish(encode(pose));
  if (pose.tracked && detail_pace_.take(detail)) {
    publish(encode(detail));
  }
  pace_.sent(*waiting_, now);
  last_sent_ = now;
  waiting_.reset();
  ++uncounted_;
}

// The broker reports a vanished client late; others notice its silence sooner.
void MeetingLink::repeat_presence() {
  const double now = seconds_now();
  if (now >= last_sent_ + kLongestSilence && connection_.drained()) {
    const MqttMessage own = presence(true);
    connection_.publish(own.topic, own.payload);
    last_sent_ = now;
  }
  presence_timer_.expires_at(at_seconds(std::max(last_sent_ + kLongestSilence, now + kShortestWait)));
  presence_timer_.async_wait([this](const boost::system::error_code& error) {
    if (!error && confirmed_) {  // a handler that was due also runs after close()
      repeat_presence();
    }
  });
}

}  // namespace telemime::meeting
