// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>

#include "meeting/protocol/participant_replay.h"
#include "meeting/transport/login.h"
#include "meeting/transport/mqtt_connection.h"

namespace telemime::meeting {

/// Maximum number of frames, each with its detail, and of chat messages of a participant that wait for the
/// broker; the newest frames stay.
inline constexpr std::size_t kQueuedPoses = 4;
inline constexpr std::size_t kQueuedChats = 100;

/// A recorded participant who takes part again, with its own connection in its own thread. It publishes each
/// step as soon as the broker accepts it, connects again after a failure (unless the first connection
/// failed), and then repeats what the broker should retain. Each session has its own connection, so that its
/// last will belongs to it.
class ReplayParticipant {
 public:
  struct Status {
    bool ready = false;   ///< connected, and the broker accepts its messages
    std::string failure;  ///< why not
    std::uint64_t frames = 0;
    std::uint64_t dropped = 0;  ///< frames that the broker did not accept in time
  };

  /// Connects at once. The others see the participant only after its first presence.
  ReplayParticipant(BrokerLogin login, std::uint16_t session);
  ReplayParticipant(const ReplayParticipant&) = delete;
  ReplayParticipant& operator=(const ReplayParticipant&) = delete;
  /// Leaves properly, within 0.5 s.
  ~ReplayParticipant();

  /// Publishes a step. Never blocks.
  void publish(ReplayStep step);
  /// Leaves the meeting and clears its pages, but stays connected.
  void leave();
  /// Whether everything is published.
  bool idle() const;
  Status status() const;
  const std::string& participant() const { return login_.participant; }

 private:
  /// What the broker should retain, and what is to be published.
  struct Pending {
    std::uint16_t session = 0;
    bool here = false;
    std::string state;
    std::map<int, std::string> pages;
    std::set<int> new_pages;
    bool new_presence = false;
    bool new_state = false;
    std::deque<std::string> poses;  ///< frames, and after each its detail if it has one
    std::deque<std::string> chats;
    std::size_t frames() const;  ///< in `poses`
    void add_pose(std::string pose, std::uint64_t& dropped);
    bool has_work() const {
      return new_presence || new_state || !new_pages.empty() || !poses.empty() || !chats.empty();
    }
  };

  void run();
  void open();
  void serve();
  void write(Pending work);
  void drain();
  void on_message(const MqttMessage& message);
  void on_own_presence(const std::string& payload);
  std::string topic(TopicKind kind, int page = 0) const;
  MqttMessage presence(bool here) const;
  void disconnect() noexcept;

  const BrokerLogin login_;
  std::atomic<bool> stopping_ = false;
  SendLoop loop_;
  const std::function<void()> wake_;
  MqttConnection connection_;
  // Used by the thread only.
  std::uint16_t open_session_ = 0;
  bool published_here_ = false;
  bool confirmed_ = false;
  bool first_ = true;                   ///< no connection has succeeded yet
  std::optional<std::uint16_t> other_;  ///< the session of another client with our id
  std::uint32_t epoch_ = 0;             ///< of the meeting
  mutable std::mutex mutex_;            ///< of what follows
  Pending pending_;
  bool working_ = false;  ///< the thread publishes what it took from `pending_`
  Status status_;
  std::thread thread_;
};

}  // namespace telemime::meeting
