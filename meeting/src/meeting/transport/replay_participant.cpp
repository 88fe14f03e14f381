// SPDX-License-Identifier: Apache-2.0
#include "meeting/transport/replay_participant.h"

#include <chrono>
#include <utility>

#include "meeting/protocol/messages.h"
#include "meeting/transport/mqtt_names.h"

namespace telemime::meeting {
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

ReplayParticipant::ReplayParticipant(BrokerLogin login, std::uint16_t session)
    : login_(std::move(login)),
      loop_([this] { return stopping_.load(); }),
      wake_(loop_.waker()),
      connection_(loop_, login_.server, [this](const MqttMessage& message) { hear(message); }) {
  wish_.session = session;
  thread_ = std::thread([this] { run(); });
}

ReplayParticipant::~ReplayParticipant() {
  stopping_ = true;
  wake_();
  thread_.join();
}

std::string ReplayParticipant::topic(TopicKind kind, int page) const {
  return topic_text(login_.meeting, {kind, login_.participant, page});
}

MqttMessage ReplayParticipant::presence(bool here) const {
  return {topic(TopicKind::presence), write_presence({here, open_session_})};
}

void ReplayParticipant::say(ReplayStep step) {
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
      case TopicKind::presence:
        wish_.here = step.here;
        wish_.new_presence = true;
        break;
      case TopicKind::state:
        wish_.state = std::move(step.payload);
        wish_.new_state = true;
        break;
      case TopicKind::board:
        wish_.pages[step.page] = std::move(step.payload);
        wish_.new_pages.insert(step.page);
        break;
      case TopicKind::chat:
        if (wish_.chats.size() < kQueuedChats) {
          wish_.chats.push_back(std::move(step.payload));
        }
        break;
      case TopicKind::pose:
        if (wish_.poses.size() == kQueuedPoses) {
          wish_.poses.pop_front();
          ++status_.dropped;
        }
        wish_.poses.push_back(std::move(step.payload));
        break;
      case TopicKind::meeting:
        return;
    }
  }
  wake_();
}

void ReplayParticipant::leave() {
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

bool ReplayParticipant::idle() const {
  const std::lock_guard lock(mutex_);
  return !wish_.has_work() && !working_;
}

ReplayParticipant::Status ReplayParticipant::status() const {
  const std::lock_guard lock(mutex_);
  return status_;
}

void ReplayParticipant::run() {
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

void ReplayParticipant::failed(const std::string& words) {
  const std::lock_guard lock(mutex_);
  status_.ready = false;
  status_.failure = words;
  working_ = false;
}

// That it is gone already is nothing new to those who are in the room. It comes back to us if the account may
// speak for this participant; MQTT 3.1.1 has no other word for that.
void ReplayParticipant::open() {
  {
    const std::lock_guard lock(mutex_);
    open_session_ = wish_.session;
  }
  said_here_ = false;
  confirmed_ = false;
  other_.reset();
  connection_.open(any_client_id(login_.participant), presence(false));
  connection_.subscribe(topic_text(login_.meeting, {TopicKind::meeting, "", 0}));
  connection_.subscribe(topic(TopicKind::presence));
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
void ReplayParticipant::serve() {
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

void ReplayParticipant::write(Wish work) {
  drain();
  if (work.new_presence) {
    said_here_ = work.here;
    connection_.keep(presence(work.here));
  }
  if (work.new_state) {
    connection_.keep({topic(TopicKind::state), work.state});
  }
  for (const int page : work.new_pages) {
    write_page(page, work.pages[page]);
  }
  for (const std::string& chat : work.chats) {
    connection_.say({topic(TopicKind::chat), chat});
  }
  for (const std::string& pose : work.poses) {
    connection_.tell(topic(TopicKind::pose), bytes_of(pose));
    const std::lock_guard lock(mutex_);
    ++status_.frames;
  }
  drain();
}

void ReplayParticipant::write_page(int page, const std::string& payload) {
  const auto now = payload.empty() ? std::optional(payload) : page_with_epoch(payload, epoch_);
  if (now) {
    connection_.keep({topic(TopicKind::board, page), *now});
  }
}

void ReplayParticipant::drain() {
  if (!loop_.wait([this] { return connection_.drained(); }, kLongestWrite)) {
    throw LinkBroken("it does not read what is sent");
  }
}

void ReplayParticipant::hear(const MqttMessage& message) {
  const auto topic = read_topic(login_.meeting, message.topic);
  if (!topic) {
    return;
  }
  if (topic->kind == TopicKind::meeting) {
    epoch_ = epoch_of_meeting(message.payload).value_or(epoch_);
  } else if (topic->kind == TopicKind::presence && topic->participant == login_.participant) {
    hear_of_oneself(message.payload);
  }
}

// An older connection of ours may have ended only now for the broker, or what was kept may have been cleared.
void ReplayParticipant::hear_of_oneself(const std::string& payload) {
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

void ReplayParticipant::goodbye() noexcept {
  const std::array<MqttMessage, 2> last_words = {presence(false), MqttMessage{topic(TopicKind::state), ""}};
  connection_.goodbye(said_here_ ? std::span<const MqttMessage>(last_words) : std::span<const MqttMessage>());
  said_here_ = false;
}

}  // namespace telemime::meeting
