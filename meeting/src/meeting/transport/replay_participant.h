// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
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
#include "meeting/transport/blocking_loop.h"
#include "meeting/transport/login.h"
#include "meeting/transport/mqtt_connection.h"

namespace telemime::meeting {

/// Poses and chat messages of a voice that wait for the broker at most; the newest stay.
inline constexpr std::size_t kQueuedPoses = 4;
inline constexpr std::size_t kQueuedChats = 100;

/// One participant of a recording who takes part again: a connection of its own in a thread of its own. It
/// says what it is told as soon as the broker takes it, connects again after a failure (unless it never came
/// in) and repeats what the broker should keep. Each session is a connection, so that its last will is of
/// that session.
class ReplayParticipant {
 public:
  struct Status {
    bool ready = false;   ///< connected, and what it says is let pass
    std::string failure;  ///< why not, in words
    std::uint64_t frames = 0;
    std::uint64_t dropped = 0;  ///< frames that the broker was too slow or too dead for
  };

  /// Connects at once; nobody sees the participant before it is told to be here.
  ReplayParticipant(BrokerLogin login, std::uint16_t session);
  ReplayParticipant(const ReplayParticipant&) = delete;
  ReplayParticipant& operator=(const ReplayParticipant&) = delete;
  /// Leaves in order, within half a second.
  ~ReplayParticipant();

  /// Never waits.
  void say(ReplayStep step);
  /// Leaves the room, stays connected, and takes its pages back.
  void leave();
  /// Whether all was said that was told.
  bool idle() const;
  Status status() const;
  const std::string& participant() const { return login_.participant; }

 private:
  struct Wish {
    std::uint16_t session = 0;
    bool here = false;
    std::string state;
    std::map<int, std::string> pages;
    std::set<int> new_pages;
    bool new_presence = false;
    bool new_state = false;
    std::deque<std::string> poses;
    std::deque<std::string> chats;
    bool has_work() const {
      return new_presence || new_state || !new_pages.empty() || !poses.empty() || !chats.empty();
    }
  };

  void run();
  void open();
  void serve();
  void write(Wish work);
  void write_page(int page, const std::string& payload);
  void drain();
  void hear(const MqttMessage& message);
  void hear_of_oneself(const std::string& payload);
  void failed(const std::string& words);
  std::string topic(TopicKind kind, int page = 0) const;
  MqttMessage presence(bool here) const;
  void goodbye() noexcept;

  const BrokerLogin login_;
  std::atomic<bool> stopping_ = false;
  BlockingLoop loop_;
  const std::function<void()> wake_;
  MqttConnection connection_;
  // The thread's.
  std::uint16_t open_session_ = 0;
  bool said_here_ = false;
  bool confirmed_ = false;
  bool first_ = true;                   ///< has not come in yet
  std::optional<std::uint16_t> other_;  ///< who is here in our place
  std::uint32_t epoch_ = 0;             ///< of the room
  mutable std::mutex mutex_;            ///< of these
  Wish wish_;
  bool working_ = false;  ///< takes from the wish what is not yet said
  Status status_;
  std::thread thread_;
};

}  // namespace telemime::meeting
