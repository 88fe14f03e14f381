// SPDX-License-Identifier: Apache-2.0
#include "meeting/transport/replay_participant.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "meeting/protocol/meeting_info.h"
#include "meeting/protocol/messages.h"
#include "meeting/protocol/pose_detail.h"

namespace telemime::meeting {
namespace {

using std::chrono::milliseconds;
using SteadyClock = std::chrono::steady_clock;

constexpr milliseconds kLongestAnswer{3000};
constexpr milliseconds kLongestWrite{5000};
constexpr milliseconds kForever = std::chrono::hours(1);

}  // namespace

std::size_t ReplayParticipant::Pending::frames() const {
  return static_cast<std::size_t>(
      std::count_if(poses.begin(), poses.end(), [](const std::string& p) { return !is_pose_detail(p); }));
}

void ReplayParticipant::Pending::add_pose(std::string pose, std::uint64_t& dropped) {
  if (is_pose_detail(pose)) {
    if (poses.size() <= 2 * kQueuedPoses) {
      poses.push_back(std::move(pose));
    }
    return;
  }
  // A frame is followed by its detail: they go together. The first may be the detail of a frame that was
  // sent.
  while (frames() >= kQueuedPoses) {
    do {
      dropped += is_pose_detail(poses.front()) ? 0 : 1;
      poses.pop_front();
    } while (is_pose_detail(poses.front()));
  }
  poses.push_back(std::move(pose));
}

ReplayParticipant::ReplayParticipant(BrokerLogin login, std::uint16_t session)
    : login_(std::move(login)),
      loop_([this] { return stopping_.load(); }),
      wake_(loop_.waker()),
      connection_(loop_, login_.server, [this](const MqttMessage& message) { on_message(message); }) {
  pending_.session = session;
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

void ReplayParticipant::publish(ReplayStep step) {
  {
    const std::lock_guard lock(mutex_);
    if (step.session != pending_.session) {  // a new run starts from nothing
      status_.dropped += pending_.frames();
      pending_.session = step.session;
      pending_.here = false;
      pending_.state.clear();
      pending_.poses.clear();
    }
    switch (step.kind) {
      case TopicKind::presence:
        pending_.here = step.here;
        pending_.new_presence = true;
        break;
      case TopicKind::state:
        pending_.state = std::move(step.payload);
        pending_.new_state = true;
        break;
      case TopicKind::board:
        pending_.pages[step.page] = std::move(step.payload);
        pending_.new_pages.insert(step.page);
        break;
      case TopicKind::chat:
        if (pending_.chats.size() < kQueuedChats) {
          pending_.chats.push_back(std::move(step.payload));
        }
        break;
      case TopicKind::pose:
        pending_.add_pose(std::move(step.payload), status_.dropped);
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
    pending_.here = false;
    pending_.state.clear();
    pending_.new_presence = true;
    pending_.new_state = true;
    for (auto& [page, payload] : pending_.pages) {
      payload.clear();
      pending_.new_pages.insert(page);
    }
  }
  wake_();
}

bool ReplayParticipant::idle() const {
  const std::lock_guard lock(mutex_);
  return !pending_.has_work() && !working_;
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
        disconnect();
        pauses = {};
      } catch (const std::exception& e) {
        const std::lock_guard lock(mutex_);
        status_.ready = false;
        status_.failure = e.what();
        working_ = false;
      }
      connection_.close();
      loop_.discard_handlers();
      const auto pause = pauses.next(SteadyClock::now() - start);
      // If even the first connection failed, the user sees the failure and there is no second attempt.
      loop_.wait([] { return false; }, first_ ? kForever : pause);
    }
  } catch (const LoopStopped&) {
    disconnect();
    connection_.close();
  }
}

// The others see a repeated absence as nothing new. It comes back to us if the account may publish for this
// participant, which MQTT 3.1.1 does not report otherwise.
void ReplayParticipant::open() {
  {
    const std::lock_guard lock(mutex_);
    open_session_ = pending_.session;
  }
  published_here_ = false;
  confirmed_ = false;
  other_.reset();
  connection_.open(random_client_id(login_.participant), presence(false));
  connection_.subscribe(topic_text(login_.meeting, {TopicKind::meeting, "", 0}));
  connection_.subscribe(topic(TopicKind::presence));
  connection_.publish_retained(presence(false));
  if (!loop_.wait([this] { return confirmed_; }, kLongestAnswer)) {
    throw LinkBroken("the account may not publish as \"" + login_.participant + "\"");
  }
  if (first_ && other_) {
    throw LinkBroken("another client takes part as \"" + login_.participant + "\"");
  }
  first_ = false;
  const std::lock_guard lock(mutex_);
  status_.ready = true;
  status_.failure.clear();
  pending_.new_presence = pending_.new_presence || pending_.here;
  pending_.new_state = pending_.new_state || !pending_.state.empty();
  for (const auto& page : pending_.pages) {
    pending_.new_pages.insert(page.first);
  }
}

// Publishes until the participant has a new session.
void ReplayParticipant::serve() {
  for (;;) {
    Pending work;
    loop_.wait(
        [this] {
          const std::lock_guard lock(mutex_);
          return pending_.has_work() || pending_.session != open_session_;
        },
        kForever);
    {
      const std::lock_guard lock(mutex_);
      if (pending_.session != open_session_) {
        return;
      }
      working_ = true;
      work = pending_;
      pending_.new_presence = pending_.new_state = false;
      pending_.new_pages.clear();
      pending_.chats.clear();
      pending_.poses.clear();
    }
    write(std::move(work));
    const std::lock_guard lock(mutex_);
    working_ = false;
  }
}

void ReplayParticipant::write(Pending work) {
  drain();
  if (work.new_presence) {
    published_here_ = work.here;
    connection_.publish_retained(presence(work.here));
  }
  if (work.new_state) {
    connection_.publish_retained({topic(TopicKind::state), work.state});
  }
  for (const int page : work.new_pages) {
    const std::string& payload = work.pages[page];
    const auto current = payload.empty() ? std::optional(payload) : page_with_epoch(payload, epoch_);
    if (current) {
      connection_.publish_retained({topic(TopicKind::board, page), *current});
    }
  }
  for (const std::string& chat : work.chats) {
    connection_.publish_reliably({topic(TopicKind::chat), chat});
  }
  for (const std::string& pose : work.poses) {
    connection_.publish(topic(TopicKind::pose), pose);
    const std::lock_guard lock(mutex_);
    status_.frames += is_pose_detail(pose) ? 0 : 1;
  }
  drain();
}

void ReplayParticipant::drain() {
  if (!loop_.wait([this] { return connection_.drained(); }, kLongestWrite)) {
    throw LinkBroken("it does not read the data");
  }
}

void ReplayParticipant::on_message(const MqttMessage& message) {
  const auto topic = read_topic(login_.meeting, message.topic);
  if (!topic) {
    return;
  }
  if (topic->kind == TopicKind::meeting) {
    epoch_ = read_epoch(message.payload).value_or(epoch_);
  } else if (topic->kind == TopicKind::presence && topic->participant == login_.participant) {
    on_own_presence(message.payload);
  }
}

// The broker may have noticed only now that an older connection of ours ended, or our messages may be
// cleared.
void ReplayParticipant::on_own_presence(const std::string& payload) {
  const auto received = read_presence(payload);
  const bool ours = received && received->session == open_session_;
  if (!confirmed_) {
    confirmed_ = ours;
    other_ = received && received->here && !ours ? std::optional(received->session) : other_;
  } else if (published_here_ && !(received && received->here)) {
    connection_.publish_retained(presence(true));
    const std::lock_guard lock(mutex_);
    pending_.new_state = pending_.new_state || !pending_.state.empty();
  }
}

void ReplayParticipant::disconnect() noexcept {
  const std::array<MqttMessage, 2> last_messages = {presence(false),
                                                    MqttMessage{topic(TopicKind::state), ""}};
  connection_.disconnect(published_here_ ? std::span<const MqttMessage>(last_messages)
                                         : std::span<const MqttMessage>());
  published_here_ = false;
}

}  // namespace telemime::meeting
