// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "meeting/protocol/pose_frame.h"

struct mosquitto;
struct mosquitto_message;

namespace telemime::meeting::test_support {

/// Hears all that is said in the room r/home/studio, and says something: libmosquitto alone, with its own
/// thread.
class Subscriber {
 public:
  struct Heard {
    std::string topic;  ///< behind the base
    std::string payload;
    bool retained;
    double at;  ///< s of the steady clock
  };

  /// `base`: what it hears instead of the room, "r/" for all rooms.
  explicit Subscriber(std::uint16_t port, const std::string& user = "", const std::string& password = "",
                      std::string base = "r/home/studio/");
  Subscriber(const Subscriber&) = delete;
  Subscriber& operator=(const Subscriber&) = delete;
  ~Subscriber();

  /// Whether the broker has granted what it asked for. It may hear something before.
  bool listens() const { return listens_; }
  std::vector<Heard> all() const;
  /// The newest of a topic; nothing before the first.
  std::optional<Heard> newest(const std::string& topic) const;
  /// The newest that is JSON, null else.
  nlohmann::json json(const std::string& topic) const;
  /// Pose frames of a participant; those that cannot be read fail the test.
  std::vector<PoseFrame> frames(const std::string& participant) const;
  /// Forgets what was heard.
  void forget();
  /// Says something, kept by the broker.
  void say(const std::string& topic, const std::string& payload);

 private:
  static void on_connect(mosquitto* client, void* self, int code);
  static void on_subscribe(mosquitto* client, void* self, int id, int count, const int* granted);
  static void on_message(mosquitto* client, void* self, const mosquitto_message* message);

  const std::string base_;
  mutable std::mutex mutex_;
  std::vector<Heard> heard_;
  std::atomic<bool> listens_ = false;
  mosquitto* client_ = nullptr;
};

}  // namespace telemime::meeting::test_support
