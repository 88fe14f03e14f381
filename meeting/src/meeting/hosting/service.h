// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "meeting/hosting/accounts.h"
#include "meeting/protocol/meeting_info.h"
#include "meeting/transport/mqtt_connection.h"

namespace telemime::meeting {

/// The program's own invisible client in a meeting: it keeps the message `room` at the broker, even when the
/// broker restarts, and observes who is present. It connects in its own thread, again after each failure.
class MeetingService {
 public:
  struct Hooks {
    std::function<void(const std::string& participant, bool here)>
        on_presence;                                          ///< from the thread, like the others
    std::function<void(const MeetingInfo& meeting)> changed;  ///< changed by a chair
    std::function<void()> lost;                               ///< no connection: nobody counts as present
  };
  MeetingService(std::filesystem::path socket, MeetingAddress address, BrokerAccount account,
                 MeetingInfo meeting, Hooks hooks);
  MeetingService(const MeetingService&) = delete;
  MeetingService& operator=(const MeetingService&) = delete;
  ~MeetingService();

  /// Sets the chairs. From any thread.
  void set_chairs(std::vector<std::string> chairs);
  /// Clears the retained messages of these participants. From any thread.
  void forget(const std::vector<std::string>& participants);

 private:
  using Clock = std::chrono::steady_clock;
  static void on_connect(mosquitto* client, void* self, int code);
  static void on_incoming(mosquitto* client, void* self, const mosquitto_message* message);

  void work();
  void serve();
  void on_message(const std::string& topic, const std::string& payload);
  void on_meeting_info(const std::string& payload);
  void publish_pending();
  bool publish(const std::string& topic, const std::string& payload);

  const std::filesystem::path socket_;
  const MeetingAddress address_;
  const BrokerAccount account_;
  const Hooks hooks_;
  const MqttLibrary library_;
  MqttClient client_;
  std::atomic<bool> closed_ = false;
  std::atomic<bool> published_ = false;
  std::optional<Clock::time_point> due_;  ///< when to publish the message `room`

  std::mutex mutex_;  ///< of what follows
  MeetingInfo meeting_;
  bool chairs_changed_ = false;
  std::vector<std::string> forgotten_;
  std::thread thread_;
};

}  // namespace telemime::meeting
