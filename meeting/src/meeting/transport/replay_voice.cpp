// SPDX-License-Identifier: Apache-2.0
#include "meeting/transport/replay_voice.h"

#include <chrono>
#include <utility>

#include "meeting/protocol/room_messages.h"
#include "meeting/transport/mqtt_names.h"

namespace telemime {
namespace {

using std::chrono::milliseconds;
using SteadyClock = std::chrono::steady_clock;

constexpr milliseconds kLongestAnswer{3000};
constexpr milliseconds kLongestWrite{5000};
constexpr milliseconds kForever = std::chrono::hours(1);
constexpr std::chrono::seconds kGoodConnection{2};

std::span<const std::uint8_t> bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

}  // namespace

ReplayVoice::ReplayVoice(RoomLogin login, std::uint16_t session)
    : login_(std::move(login)),
      loop_([this] { return stopping_.load(); }),
      wake_(loop_.waker()),
      connection_(loop_, login_.server, [this](const MqttMessage& message) { hear(message); }) {
  wish_.session = session;
  thread_ = std::thread([this] { run(); });
}

ReplayVoice::~ReplayVoice() {
  stopping_ = true;
  wake_();
  thread_.join();
}

std::string ReplayVoice::topic(RoomTopicKind kind, int page) const {
  return topic_text(login_.room, {kind, login_.participant, page});
}

MqttMessage ReplayVoice::presence(bool here) const {
  return {topic(RoomTopicKind::presence), write_presence({here, open_session_})};
}

void ReplayVoice::say(ReplayStep step) {
  {
    const std::lock_guard lock(mutex_);
    if (step.session != wish_.session) {  // a new run, which knows nothing of the one before
      status_.dropped += wish_.poses.size();
      wish_.session = step.session;
      wish_.here = false;
      wish_.state.clear();
      wish_.poses.clear();
    }
    switch (step.kind) {
      case RoomTopicKind::presence:
        wish_.here = step.here;
        wish_.new_presence = true;
        break;
      case RoomTopicKind::state:
        wish_.state = std::move(step.payload);
        wish_.new_state = true;
        break;
      case RoomTopicKind::board:
        wish_.pages[step.page] = std::move(step.payload);
        wish_.new_pages.insert(step.page);
        break;
      case RoomTopicKind::chat:
        if (wish_.chats.size() < kVoiceChats) {
          wish_.chats.push_back(std::move(step.payload));
        }
        break;
      case RoomTopicKind::pose:
        if (wish_.poses.size() == kVoicePoses) {
          wish_.poses.pop_front();
          ++status_.dropped;
        }
        wish_.poses.push_back(std::move(step.payload));
        break;
      case RoomTopicKind::room:
        return;
    }
  }
  wake_();
}

void ReplayVoice::leave() {
  {
    const std::lock_guard lock(mutex_);
    wish_.here = false;
    wish_.state.clear();
    wish_.new_presence = true;
    wish_.new_state = true;
    for (auto& [page, payload] : wish_.pages) {
      payload.clear();
      wish_.new_pages.insert(page);
    }
  }
  wake_();
}

bool ReplayVoice::idle() const {
  const std::lock_guard lock(mutex_);
  return !wish_.has_work() && !working_;
}

ReplayVoice::Status ReplayVoice::status() const {
  const std::lock_guard lock(mutex_);
  return status_;
}

void ReplayVoice::run() {
  RetryPauses pauses;
  try {
    for (;;) {
      const auto start = SteadyClock::now();
      try {
        open();
        serve();
        goodbye();
        pauses.reset();
      } catch (const std::exception& e) {
        failed(e.what());
        if (SteadyClock::now() - start >= kGoodConnection) {
          pauses.reset();
        }
      }
      connection_.close();
      loop_.forget_old_handlers();
      // Who could not come in at all does not try again: that is for the user to see.
      loop_.wait([] { return false; }, first_ ? kForever : pauses.next());
    }
  } catch (const LoopStopped&) {
    goodbye();
    connection_.close();
  }
}

void ReplayVoice::failed(const std::string& words) {
  const std::lock_guard lock(mutex_);
  status_.ready = false;
  status_.failure = words;
  working_ = false;
}

// That it is gone already is nothing new to those who are in the room. It comes back to us if the account may
// speak for this participant; MQTT 3.1.1 has no other word for that.
void ReplayVoice::open() {
  {
    const std::lock_guard lock(mutex_);
    open_session_ = wish_.session;
  }
  said_here_ = false;
  confirmed_ = false;
  other_.reset();
  connection_.open(any_client_id(login_.participant), presence(false));
  connection_.subscribe(topic_text(login_.room, {RoomTopicKind::room, "", 0}));
  connection_.subscribe(topic(RoomTopicKind::presence));
  connection_.keep(presence(false));
  if (!loop_.wait([this] { return confirmed_; }, kLongestAnswer)) {
    throw LinkBroken("it lets nothing pass that we say as \"" + login_.participant +
                     "\": the account may not publish there");
  }
  if (first_ && other_) {
    throw LinkBroken("somebody takes part as \"" + login_.participant + "\" there");
  }
  first_ = false;
  const std::lock_guard lock(mutex_);
  status_.ready = true;
  status_.failure.clear();
  wish_.new_presence = wish_.new_presence || wish_.here;
  wish_.new_state = wish_.new_state || !wish_.state.empty();
  for (const auto& page : wish_.pages) {
    wish_.new_pages.insert(page.first);
  }
}

// Until the participant has a new session.
void ReplayVoice::serve() {
  for (;;) {
    Wish work;
    loop_.wait(
        [this] {
          const std::lock_guard lock(mutex_);
          return wish_.has_work() || wish_.session != open_session_;
        },
        kForever);
    {
      const std::lock_guard lock(mutex_);
      if (wish_.session != open_session_) {
        return;
      }
      working_ = true;
      work = wish_;
      wish_.new_presence = wish_.new_state = false;
      wish_.new_pages.clear();
      wish_.chats.clear();
      wish_.poses.clear();
    }
    write(std::move(work));
    const std::lock_guard lock(mutex_);
    working_ = false;
  }
}

void ReplayVoice::write(Wish work) {
  drain();
  if (work.new_presence) {
    said_here_ = work.here;
    connection_.keep(presence(work.here));
  }
  if (work.new_state) {
    connection_.keep({topic(RoomTopicKind::state), work.state});
  }
  for (const int page : work.new_pages) {
    write_page(page, work.pages[page]);
  }
  for (const std::string& chat : work.chats) {
    connection_.say({topic(RoomTopicKind::chat), chat});
  }
  for (const std::string& pose : work.poses) {
    connection_.tell(topic(RoomTopicKind::pose), bytes_of(pose));
    const std::lock_guard lock(mutex_);
    ++status_.frames;
  }
  drain();
}

void ReplayVoice::write_page(int page, const std::string& payload) {
  const auto now = payload.empty() ? std::optional(payload) : page_with_epoch(payload, epoch_);
  if (now) {
    connection_.keep({topic(RoomTopicKind::board, page), *now});
  }
}

void ReplayVoice::drain() {
  if (!loop_.wait([this] { return connection_.drained(); }, kLongestWrite)) {
    throw LinkBroken("it does not read what is sent");
  }
}

void ReplayVoice::hear(const MqttMessage& message) {
  const auto topic = read_topic(login_.room, message.topic);
  if (!topic) {
    return;
  }
  if (topic->kind == RoomTopicKind::room) {
    epoch_ = room_epoch(message.payload).value_or(epoch_);
  } else if (topic->kind == RoomTopicKind::presence && topic->participant == login_.participant) {
    hear_of_oneself(message.payload);
  }
}

// An older connection of ours may have ended only now for the broker, or what was kept may have been cleared.
void ReplayVoice::hear_of_oneself(const std::string& payload) {
  const auto heard = read_presence(payload);
  const bool ours = heard && heard->session == open_session_;
  if (!confirmed_) {
    confirmed_ = ours;
    other_ = heard && heard->here && !ours ? std::optional(heard->session) : other_;
  } else if (said_here_ && !(heard && heard->here)) {
    connection_.keep(presence(true));
    const std::lock_guard lock(mutex_);
    wish_.new_state = wish_.new_state || !wish_.state.empty();
  }
}

void ReplayVoice::goodbye() noexcept {
  const std::array<MqttMessage, 2> last_words = {presence(false),
                                                 MqttMessage{topic(RoomTopicKind::state), ""}};
  connection_.goodbye(said_here_ ? std::span<const MqttMessage>(last_words) : std::span<const MqttMessage>());
  said_here_ = false;
}

}  // namespace telemime
