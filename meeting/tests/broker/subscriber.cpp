// SPDX-License-Identifier: Apache-2.0
#include "subscriber.h"

#include <gtest/gtest.h>
#include <mosquitto.h>

#include <algorithm>
#include <chrono>
#include <string_view>
#include <utility>

#include "meeting/protocol/pose_detail.h"
#include "meeting/protocol/testing.h"
#include "telemime/streaming/testing_receivers.h"

namespace telemime::meeting::test_support {
namespace {

constexpr int kKeepAlive = 60;
constexpr int kRefused = 0x80;  // MQTT 3.1.1, 3.9.3

}  // namespace

Subscriber::Subscriber(std::uint16_t port, const std::string& user, const std::string& password,
                       std::string base)
    : base_(std::move(base)) {
  mosquitto_lib_init();
  client_ = mosquitto_new(nullptr, true, this);
  mosquitto_connect_callback_set(client_, on_connect);
  mosquitto_subscribe_callback_set(client_, on_subscribe);
  mosquitto_message_callback_set(client_, on_message);
  if (!user.empty()) {
    mosquitto_username_pw_set(client_, user.c_str(), password.c_str());
  }
  EXPECT_EQ(mosquitto_connect(client_, "127.0.0.1", port, kKeepAlive), MOSQ_ERR_SUCCESS);
  EXPECT_EQ(mosquitto_loop_start(client_), MOSQ_ERR_SUCCESS);
  // Until then, messages that are not retained would be lost.
  EXPECT_TRUE(testing_receivers::comes_true([this] { return subscribed_.load(); })) << "not subscribed";
}

Subscriber::~Subscriber() {
  mosquitto_disconnect(client_);
  mosquitto_loop_stop(client_, /*force=*/true);
  mosquitto_destroy(client_);
  mosquitto_lib_cleanup();
}

void Subscriber::on_connect(mosquitto* client, void* self, int code) {
  EXPECT_EQ(code, 0);
  mosquitto_subscribe(client, nullptr, (static_cast<Subscriber*>(self)->base_ + "#").c_str(), 1);
}

// A cluster that has just lost a node may not be able to grant more than QoS 0.
void Subscriber::on_subscribe(mosquitto* client, void* self, int /*id*/, int /*count*/, const int* granted) {
  if (*granted == kRefused) {
    mosquitto_subscribe(client, nullptr, (static_cast<Subscriber*>(self)->base_ + "#").c_str(), 0);
  } else {
    static_cast<Subscriber*>(self)->subscribed_ = true;
  }
}

void Subscriber::on_message(mosquitto* /*client*/, void* self, const mosquitto_message* message) {
  auto& subscriber = *static_cast<Subscriber*>(self);
  const std::string_view topic(message->topic);
  EXPECT_TRUE(topic.starts_with(subscriber.base_));
  const auto size = static_cast<std::size_t>(message->payloadlen);
  const std::chrono::duration<double> now = std::chrono::steady_clock::now().time_since_epoch();
  const std::lock_guard lock(subscriber.mutex_);
  subscriber.received_.push_back(
      {std::string(topic.substr(subscriber.base_.size())),
       size == 0 ? "" : std::string(static_cast<const char*>(message->payload), size), message->retain,
       now.count()});
}

std::vector<Subscriber::Received> Subscriber::all() const {
  const std::lock_guard lock(mutex_);
  return received_;
}

std::optional<Subscriber::Received> Subscriber::newest(const std::string& topic) const {
  const std::lock_guard lock(mutex_);
  const auto found = std::find_if(received_.rbegin(), received_.rend(),
                                  [&](const Received& message) { return message.topic == topic; });
  return found == received_.rend() ? std::nullopt : std::optional(*found);
}

nlohmann::json Subscriber::json(const std::string& topic) const {
  const auto message = newest(topic);
  return message && !message->payload.empty() ? nlohmann::json::parse(message->payload) : nlohmann::json();
}

std::vector<std::string> Subscriber::payloads(const std::string& topic) const {
  std::vector<std::string> payloads;
  for (const Received& message : all()) {
    if (message.topic == topic) {
      payloads.push_back(message.payload);
    }
  }
  return payloads;
}

std::vector<PoseFrame> Subscriber::frames(const std::string& participant) const {
  std::vector<PoseFrame> frames;
  for (const Received& message : all()) {
    if (message.topic == "p/" + participant + "/pose" && !is_pose_detail(message.payload)) {
      EXPECT_FALSE(message.retained);
      frames.push_back(frame_of(message.payload));
    }
  }
  return frames;
}

void Subscriber::clear() {
  const std::lock_guard lock(mutex_);
  received_.clear();
}

void Subscriber::publish(const std::string& topic, const std::string& payload) {
  EXPECT_EQ(mosquitto_publish(client_, nullptr, (base_ + topic).c_str(), static_cast<int>(payload.size()),
                              payload.data(), 1, /*retain=*/true),
            MOSQ_ERR_SUCCESS);
}

}  // namespace telemime::meeting::test_support
