// SPDX-License-Identifier: Apache-2.0
#include "meeting/hosting/room_service.h"

#include <mosquitto.h>

#include <string_view>
#include <utility>

#include "meeting/protocol/room_messages.h"
#include "telemime/core/errors.h"

namespace telemime {
namespace {

constexpr int kKeepAlive = 10;  // s
constexpr int kTick = 50;       // ms
constexpr std::chrono::milliseconds kPause{100};
// What the broker still keeps comes before that; what a chair says meanwhile is not talked over.
constexpr std::chrono::milliseconds kListenFirst{200};
constexpr std::chrono::milliseconds kTellAgain{300};
constexpr int kAtLeastOnce = 1;
constexpr std::size_t kLongestPayload = 16384;

}  // namespace

void RoomService::Destroy::operator()(mosquitto* client) const {
  mosquitto_destroy(client);
}

RoomService::RoomService(std::filesystem::path socket, RoomAddress address, BrokerAccount account,
                         RoomInfo room, Hooks hooks)
    : socket_(std::move(socket)),
      address_(std::move(address)),
      account_(std::move(account)),
      hooks_(std::move(hooks)),
      room_(std::move(room)) {
  client_.reset(mosquitto_new(nullptr, /*clean_session=*/true, this));
  if (!client_) {
    throw Error(ErrorKind::output, "no connection to the broker can be made here");
  }
  mosquitto_int_option(client_.get(), MOSQ_OPT_PROTOCOL_VERSION, MQTT_PROTOCOL_V311);
  mosquitto_username_pw_set(client_.get(), account_.user.c_str(), account_.password.c_str());
  mosquitto_connect_callback_set(client_.get(), on_connect);
  mosquitto_message_callback_set(client_.get(), on_message);
  thread_ = std::thread([this] { work(); });
}

RoomService::~RoomService() {
  end_ = true;
  thread_.join();
}

void RoomService::on_connect(mosquitto* client, void* self, int code) {
  auto& own = *static_cast<RoomService*>(self);
  if (code == 0) {
    for (const std::string& filter :
         {presence_filter(own.address_), topic_text(own.address_, {RoomTopicKind::room, "", 0})}) {
      mosquitto_subscribe(client, nullptr, filter.c_str(), kAtLeastOnce);
    }
    own.due_ = Clock::now() + kListenFirst;
  }
}

void RoomService::on_message(mosquitto* /*client*/, void* self, const mosquitto_message* message) {
  const auto size = static_cast<std::size_t>(message->payloadlen);
  if (size <= kLongestPayload) {
    static_cast<RoomService*>(self)->hear(
        message->topic, size == 0 ? "" : std::string(static_cast<const char*>(message->payload), size));
  }
}

void RoomService::work() {
  while (!end_) {
    told_ = false;
    if (mosquitto_connect(client_.get(), socket_.c_str(), 0, kKeepAlive) == MOSQ_ERR_SUCCESS) {
      talk();
      hooks_.lost();
    }
    if (!end_) {
      std::this_thread::sleep_for(kPause);
    }
  }
}

// Until the connection breaks.
void RoomService::talk() {
  while (mosquitto_loop(client_.get(), kTick, 1) == MOSQ_ERR_SUCCESS) {
    say_what_is_due();
    if (end_) {
      mosquitto_disconnect(client_.get());
      return;
    }
  }
  due_.reset();
}

bool RoomService::publish(const std::string& topic, const std::string& payload) {
  return mosquitto_publish(client_.get(), nullptr, topic.c_str(), static_cast<int>(payload.size()),
                           payload.data(), kAtLeastOnce, /*retain=*/true) == MOSQ_ERR_SUCCESS;
}

void RoomService::say_what_is_due() {
  std::vector<std::string> forgotten;
  std::optional<RoomInfo> room;
  {
    const std::lock_guard lock(mutex_);
    if (std::exchange(chairs_changed_, false) && told_) {
      due_ = Clock::now();
    }
    if (due_ && Clock::now() >= *due_) {
      room = room_;
      due_.reset();
    }
    if (told_) {  // else there is nothing: the broker is a new one
      forgotten.swap(forgotten_);
    }
  }
  if (room) {
    told_ = publish(topic_text(address_, {RoomTopicKind::room, "", 0}), write_room_info(*room));
  }
  for (const std::string& id : forgotten) {
    for (const RoomTopicKind kind :
         {RoomTopicKind::presence, RoomTopicKind::state, RoomTopicKind::chat, RoomTopicKind::pose}) {
      publish(topic_text(address_, {kind, id, 0}), "");
    }
    for (int page = 0; page < kMostBoardPages; ++page) {
      publish(topic_text(address_, {RoomTopicKind::board, id, page}), "");
    }
  }
}

void RoomService::hear(const std::string& text, const std::string& payload) {
  const auto topic = read_topic(address_, text);
  if (!topic) {
    return;
  }
  if (topic->kind == RoomTopicKind::room) {
    hear_room(payload);
  } else if (topic->kind == RoomTopicKind::presence) {
    const auto presence = read_presence(payload);
    hooks_.seen(topic->participant, presence && presence->here);
  }
}

void RoomService::hear_room(const std::string& payload) {
  const std::optional<RoomInfo> said = read_room_info(payload);
  std::optional<RoomInfo> next;
  bool wrong = false;
  {
    const std::lock_guard lock(mutex_);
    next = after_hearing(room_, said);
    room_ = next.value_or(room_);
    wrong = said != room_;
  }
  if (wrong) {
    due_ = due_.value_or(Clock::now() + kTellAgain);
  }
  if (next) {
    hooks_.changed(*next);
  }
}

void RoomService::set_chairs(std::vector<std::string> chairs) {
  const std::lock_guard lock(mutex_);
  chairs_changed_ = chairs_changed_ || chairs != room_.chairs;
  room_.chairs = std::move(chairs);
}

void RoomService::forget(const std::vector<std::string>& participants) {
  const std::lock_guard lock(mutex_);
  forgotten_.insert(forgotten_.end(), participants.begin(), participants.end());
}

}  // namespace telemime
