// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "meeting/hosting/accounts.h"
#include "meeting/protocol/meeting_info.h"
#include "meeting/transport/mqtt_library.h"

struct mosquitto;
struct mosquitto_message;

namespace telemime::meeting {

/// The room's own participant, whom nobody sees: it keeps what the room is with the broker, whatever happens
/// to that, and hears who is here. A thread of its own connects, again and again.
class MeetingService {
 public:
  struct Hooks {
    std::function<void(const std::string& participant, bool here)> seen;  ///< from its thread, as the others
    std::function<void(const MeetingInfo& meeting)> changed;              ///< by a chair
    std::function<void()> lost;  ///< there is no connection: nobody is known to be here
  };
  MeetingService(std::filesystem::path socket, MeetingAddress address, BrokerAccount account,
                 MeetingInfo meeting, Hooks hooks);
  MeetingService(const MeetingService&) = delete;
  MeetingService& operator=(const MeetingService&) = delete;
  ~MeetingService();

  /// From any thread: these are the chairs from now on.
  void set_chairs(std::vector<std::string> chairs);
  /// From any thread: what the broker keeps of these participants goes.
  void forget(const std::vector<std::string>& participants);
  /// Whether the broker has what the room is.
  bool told() const { return told_; }

 private:
  using Clock = std::chrono::steady_clock;
  struct Destroy {
    void operator()(mosquitto* client) const;
  };
  static void on_connect(mosquitto* client, void* self, int code);
  static void on_message(mosquitto* client, void* self, const mosquitto_message* message);

  void work();
  void talk();
  void hear(const std::string& topic, const std::string& payload);
  void hear_room(const std::string& payload);
  void say_what_is_due();
  bool publish(const std::string& topic, const std::string& payload);

  const std::filesystem::path socket_;
  const MeetingAddress address_;
  const BrokerAccount account_;
  const Hooks hooks_;
  const MqttLibrary library_;
  std::unique_ptr<mosquitto, Destroy> client_;
  std::atomic<bool> end_ = false;
  std::atomic<bool> told_ = false;
  std::optional<Clock::time_point> due_;  ///< when the room is told

  std::mutex mutex_;  ///< of what follows
  MeetingInfo meeting_;
  bool chairs_changed_ = false;
  std::vector<std::string> forgotten_;
  std::thread thread_;
};

}  // namespace telemime::meeting
