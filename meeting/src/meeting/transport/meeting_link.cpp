// SPDX-License-Identifier: Apache-2.0
#include "meeting/transport/meeting_link.h"

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/address.hpp>
#include <chrono>
#include <cmath>
#include <utility>

#include "meeting/protocol/tracked_pose.h"
#include "meeting/transport/mqtt_names.h"

namespace telemime::meeting {
namespace {

using std::chrono::milliseconds;
using SteadyClock = std::chrono::steady_clock;

constexpr milliseconds kLongestAnswer{3000};
constexpr milliseconds kSlowWrite{1000};
constexpr milliseconds kLongestWrite{4000};  // after that
/// What others can rely on, s: frames may not come for a while.
constexpr double kPromise = 1.25;
constexpr double kLongestSilence = 1.0;  // s: there is time to be late
constexpr double kShortestWait = 0.1;    // s, while a connection takes nothing
/// What a page on our seat says so soon after we came in was on its way, s: it then makes room.
constexpr double kCrossing = 1.0;
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
      session_(any_session()),
      pose_topic_(topic(TopicKind::pose)),
      last_words_{presence(false), MqttMessage{topic(TopicKind::state), ""}},
      connection_(loop, output_.server, [this](const MqttMessage& message) { hear(message); }),
      timer_(loop.io()),
      breath_(loop.io()) {}

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

std::string MeetingLink::words() const {
  std::string words = output_.warning;
  const auto add = [&words](const std::string& more) { words += (words.empty() ? "" : "; ") + more; };
  if (!output_.server.ca_file && !output_.server.password.empty() && !is_this_computer(output_.server.host)) {
    add("the password travels unencrypted, which mqtts:// would change");
  }
  if (twin_) {
    add("somebody else takes part as \"" + output_.participant + "\", too");
  }
  return words;
}

void MeetingLink::open() {
  here_ = {};
  confirmed_.reset();
  twin_ = false;
  waiting_.reset();
  connection_.open(any_client_id(output_.participant), presence(false));
  connection_.subscribe(presence_filter(output_.meeting));
  connection_.keep(presence(true));
  connection_.keep(state());
  // MQTT 3.1.1 has no word for what a broker does not let pass. What it lets pass comes back to us.
  if (!loop_.wait([this] { return confirmed_.has_value(); }, kLongestAnswer)) {
    throw LinkBroken("it lets nothing pass that we say as \"" + output_.participant +
                     "\": the account may not publish there");
  }
  loop_.sending(words());
  count_participants();
  said_ = seconds_now();
  breathe_when_silent();
}

void MeetingLink::person(const std::shared_ptr<const StreamHeader>& person) {
  if (person_ != person) {
    motion_.emplace(person->body);
    person_ = person;
    waiting_.reset();
  }
  connection_.keep(state());
}

bool MeetingLink::frame(const MotionFrame& raw, double taken) {
  drain();
  const MotionFrame frame = motion_->clean(raw);
  const auto motion = (*motion_)(frame);
  waiting_ = motion ? pose_frame_of(*motion, frame.spread) : PoseFrame();
  waiting_->captured = microseconds(taken);
  send_when_due();
  const bool sent = uncounted_ > 0;
  uncounted_ -= sent ? 1 : 0;
  return sent;
}

void MeetingLink::close() noexcept {
  boost::system::error_code ignored;
  timer_.cancel(ignored);
  breath_.cancel(ignored);
  waiting_.reset();
  confirmed_.reset();
  connection_.goodbye(last_words_);
  connection_.close();
}

void MeetingLink::hear(const MqttMessage& message) {
  const auto topic = read_topic(output_.meeting, message.topic);
  if (!topic || topic->kind != TopicKind::presence) {
    return;
  }
  here_.heard(topic->participant, message.payload);
  if (topic->participant == output_.participant) {
    if (message.payload.empty()) {
      hear_that_we_are_gone();
    } else if (const auto presence = read_presence(message.payload)) {
      hear_of_oneself(*presence);
    }
  }
  count_participants();
}

void MeetingLink::hear_of_oneself(const ParticipantPresence& presence) {
  if (!presence.here) {
    hear_that_we_are_gone();
  } else if (presence.session == session_) {
    confirmed_ = confirmed_ ? confirmed_ : seconds_now();
  } else if (confirmed_ && seconds_now() > *confirmed_ + kCrossing) {  // else it was left by an earlier run
    twin_ = true;
    loop_.sending(words());
  }
}

// An older connection of ours may have ended only now for the broker, somebody else under our name may have
// left, or what was kept of us may have been cleared away.
void MeetingLink::hear_that_we_are_gone() {
  if (confirmed_) {
    twin_ = false;
    loop_.sending(words());
    connection_.keep(presence(true));
    connection_.keep(state());
  }
}

void MeetingLink::count_participants() {
  const std::size_t others = here_.count() - (here_.has(output_.participant) ? 1 : 0);
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
      throw LinkBroken("it does not read what is sent");
    }
    loop_.sending(words());
  }
}

void MeetingLink::send_when_due() {
  if (!waiting_ || !connection_.drained()) {
    return;
  }
  const double now = seconds_now();
  const double due = pace_.due(*waiting_);
  if (due > now) {
    timer_.expires_at(at_seconds(due));
    timer_.async_wait([this](const boost::system::error_code& error) {
      if (!error) {
        send_when_due();
      }
    });
    return;
  }
  waiting_->session = session_;
  waiting_->sequence = sequence_++;
  // A person who is left has no picture of their own: the time of the one before.
  waiting_->captured = captured_ = std::max(waiting_->captured, captured_ + 1);
  waiting_->still = pace_.still(*waiting_);
  connection_.tell(pose_topic_, encode(*waiting_));
  pace_.sent(*waiting_, now);
  said_ = now;
  waiting_.reset();
  ++uncounted_;
}

// The broker tells others late that somebody has vanished; that they are silent is heard at once.
void MeetingLink::breathe_when_silent() {
  const double now = seconds_now();
  if (now >= said_ + kLongestSilence && connection_.drained()) {
    const MqttMessage breath = presence(true);
    const auto* const bytes = reinterpret_cast<const std::uint8_t*>(breath.payload.data());
    connection_.tell(breath.topic, {bytes, breath.payload.size()});
    said_ = now;
  }
  breath_.expires_at(at_seconds(std::max(said_ + kLongestSilence, now + kShortestWait)));
  breath_.async_wait([this](const boost::system::error_code& error) {
    if (!error && confirmed_) {  // what was due when the connection was closed comes all the same
      breathe_when_silent();
    }
  });
}

}  // namespace telemime::meeting
