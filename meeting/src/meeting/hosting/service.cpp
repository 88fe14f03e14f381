// SPDX-License-Identifier: Apache-2.0
#include "meeting/hosting/service.h"

#include <mosquitto.h>

#include <utility>

#include "meeting/protocol/messages.h"
#include "telemime/core/errors.h"

namespace telemime::meeting {
namespace {

constexpr int kKeepAlive = 10;  // s
constexpr int kTick = 50;       // ms
constexpr std::chrono::milliseconds kPause{100};
// Retained messages and changes by a chair arrive in this time and are not overwritten.
constexpr std::chrono::milliseconds kSettle{200};
constexpr std::chrono::milliseconds kRepeat{300};
constexpr int kAtLeastOnce = 1;

}  // namespace

MeetingService::MeetingService(std::filesystem::path socket, MeetingAddress address, BrokerAccount account,
                               MeetingInfo meeting, Hooks hooks)
    : socket_(std::move(socket)),
      address_(std::move(address)),
      account_(std::move(account)),
      hooks_(std::move(hooks)),
      meeting_(std::move(meeting)) {
  client_.reset(mosquitto_new(nullptr, /*clean_session=*/true, this));
  if (!client_) {
    throw Error(ErrorKind::output, "no MQTT client can be created");
  }
  mosquitto_int_option(client_.get(), MOSQ_OPT_PROTOCOL_VERSION, MQTT_PROTOCOL_V311);
  mosquitto_username_pw_set(client_.get(), account_.user.c_str(), account_.password.c_str());
  mosquitto_connect_callback_set(client_.get(), on_connect);
  mosquitto_message_callback_set(client_.get(), on_incoming);
  thread_ = std::thread([this] { work(); });
}

MeetingService::~MeetingService() {
  closed_ = true;
  thread_.join();
}

void MeetingService::on_connect(mosquitto* client, void* self, int code) {
  auto& own = *static_cast<MeetingService*>(self);
  if (code == 0) {
    for (const std::string& filter :
         {presence_filter(own.address_), topic_text(own.address_, {TopicKind::meeting, "", 0})}) {
      mosquitto_subscribe(client, nullptr, filter.c_str(), kAtLeastOnce);
    }
    own.due_ = Clock::now() + kSettle;
  }
}

void MeetingService::on_incoming(mosquitto* /*client*/, void* self, const mosquitto_message* message) {
  const auto size = static_cast<std::size_t>(message->payloadlen);
  if (size <= kLongestPayload) {
    static_cast<MeetingService*>(self)->on_message(
        message->topic, size == 0 ? "" : std::string(static_cast<const char*>(message->payload), size));
  }
}

void MeetingService::work() {
  while (!closed_) {
    published_ = false;
    if (mosquitto_connect(client_.get(), socket_.c_str(), 0, kKeepAlive) == MOSQ_ERR_SUCCESS) {
      serve();
      hooks_.lost();
    }
    if (!closed_) {
      std::this_thread::sleep_for(kPause);
    }
  }
}

// Serves until the connection breaks.
void MeetingService::serve() {
  while (mosquitto_loop(client_.get(), kTick, 1) == MOSQ_ERR_SUCCESS) {
    publish_pending();
    if (closed_) {
      mosquitto_disconnect(client_.get());
      return;
    }
  }
  due_.reset();
}

bool MeetingService::publish(const std::string& topic, const std::string& payload) {
  return mosquitto_publish(client_.get(), nullptr, topic.c_str(), static_cast<int>(payload.size()),
                           payload.data(), kAtLeastOnce, /*retain=*/true) == MOSQ_ERR_SUCCESS;
}

void MeetingService::publish_pending() {
  std::vector<std::string> forgotten;
  std::optional<MeetingInfo> meeting;
  {
    const std::lock_guard lock(mutex_);
    if (std::exchange(chairs_changed_, false) && published_) {
      due_ = Clock::now();
    }
    if (due_ && Clock::now() >= *due_) {
      meeting = meeting_;
      due_.reset();
    }
    if (published_) {  // otherwise the broker is new and retains nothing
      forgotten.swap(forgotten_);
    }
  }
  if (meeting) {
    published_ = publish(topic_text(address_, {TopicKind::meeting, "", 0}), write_meeting_info(*meeting));
  }
  for (const std::string& id : forgotten) {
    for (const TopicKind kind : {TopicKind::presence, TopicKind::state, TopicKind::chat, TopicKind::pose}) {
      publish(topic_text(address_, {kind, id, 0}), "");
    }
    for (int page = 0; page < kMostBoardPages; ++page) {
      publish(topic_text(address_, {TopicKind::board, id, page}), "");
    }
  }
}

void MeetingService::on_message(const std::string& text, const std::string& payload) {
  const auto topic = read_topic(address_, text);
  if (!topic) {
    return;
  }
  if (topic->kind == TopicKind::meeting) {
    on_meeting_info(payload);
  } else if (topic->kind == TopicKind::presence) {
    const auto presence = read_presence(payload);
    hooks_.on_presence(topic->participant, presence && presence->here);
  }
}

void MeetingService::on_meeting_info(const std::string& payload) {
  const std::optional<MeetingInfo> received = read_meeting_info(payload);
  std::optional<MeetingInfo> next;
  bool differs = false;
  {
    const std::lock_guard lock(mutex_);
    next = after_change(meeting_, received);
    meeting_ = next.value_or(meeting_);
    differs = received != meeting_;
  }
  if (differs) {
    due_ = due_.value_or(Clock::now() + kRepeat);
  }
  if (next) {
    hooks_.changed(*next);
  }
}

void MeetingService::set_chairs(std::vector<std::string> chairs) {
  const std::lock_guard lock(mutex_);
  chairs_changed_ = chairs_changed_ || chairs != meeting_.chairs;
  meeting_.chairs = std::move(chairs);
}

void MeetingService::forget(const std::vector<std::string>& participants) {
  const std::lock_guard lock(mutex_);
  forgotten_.insert(forgotten_.end(), participants.begin(), participants.end());
}

}  // namespace telemime::meeting
