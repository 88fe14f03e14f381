// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "meeting/protocol/pose_frame.h"

struct mosquitto;
struct mosquitto_message;

namespace telemime::meeting::test_support {

/// Receives all messages of the meeting r/home/studio, and can publish. Uses libmosquitto alone, with its
/// thread.
class Subscriber {
 public:
  struct Received {
    std::string topic;  ///< after the base
    std::string payload;
    bool retained;
    double at;  ///< s of the steady clock
  };
  /// Returns when the broker has granted the subscription: what is published after that is received. `base`:
  /// the topics to receive; "r/" for all meetings.
  explicit Subscriber(std::uint16_t port, const std::string& user = "", const std::string& password = "",
                      std::string base = "r/home/studio/");
  Subscriber(const Subscriber&) = delete;
  Subscriber& operator=(const Subscriber&) = delete;
  ~Subscriber();

  std::vector<Received> all() const;
  /// The payloads of a topic, in order.
  std::vector<std::string> payloads(const std::string& topic) const;
  /// The newest message of a topic; nothing before the first.
  std::optional<Received> newest(const std::string& topic) const;
  /// The newest message of a topic as JSON; null before the first and when it is empty.
  nlohmann::json json(const std::string& topic) const;
  /// The pose frames of a participant; an invalid one fails the test.
  std::vector<PoseFrame> frames(const std::string& participant) const;
  /// Forgets what was received.
  void clear();
  /// Publishes a retained message.
  void publish(const std::string& topic, const std::string& payload);

 private:
  static void on_connect(mosquitto* client, void* self, int code);
  static void on_subscribe(mosquitto* client, void* self, int id, int count, const int* granted);
  static void on_message(mosquitto* client, void* self, const mosquitto_message* message);

  const std::string base_;
  mutable std::mutex mutex_;
  std::vector<Received> received_;
  std::atomic<bool> subscribed_ = false;
  mosquitto* client_ = nullptr;
};

}  // namespace telemime::meeting::test_support
