// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include "telemime/capture/clock.h"
#include "telemime/live/commands.h"
#include "telemime/live/live_statistics.h"
#include "telemime/live/recorder.h"
#include "telemime/live/sender_list.h"

namespace telemime {

/// Does what pages ask for. What is kept for later runs follows the pages of this computer alone: whoever
/// else may reach the page changes this run, not the user's settings. For the server's thread, unless said
/// otherwise.
class LiveAnswers {
 public:
  struct Hooks {
    std::function<void(std::uint64_t client, int topic, bool on)> topic;  ///< WebServer::set_topic
    std::function<void()> changed;                        ///< there is a new status to be told
    std::function<bool(std::uint64_t client)> from_here;  ///< WebServer::from_here
    std::function<void(const std::string& url)> keep;     ///< KeptOutputs::keep
    std::function<void(const std::string& url)> forget;   ///< KeptOutputs::forget
  };
  LiveAnswers(Recorder& recorder, SenderList& senders, Clock clock, Hooks hooks)
      : recorder_(recorder), senders_(senders), clock_(std::move(clock)), hooks_(std::move(hooks)) {}

  /// From any thread: from now on there is a session, until the server is gone.
  void begin(LiveSession& session) { session_ = &session; }

  /// The answer to a message of a page, if there is one.
  std::optional<std::string> operator()(std::uint64_t client, std::string_view text);

  /// From any thread: from the camera to the avatar drawn, as pages measured it.
  std::optional<LatencyRecord::Summary> latency() const;

 private:
  using Answer = std::optional<std::string>;
  Answer carry_out(std::uint64_t client, const Guide& command);
  Answer carry_out(std::uint64_t client, const Recalibrate& command);
  Answer carry_out(std::uint64_t client, const AddOutput& command);
  Answer carry_out(std::uint64_t client, const SwitchOutputOff& command);
  Answer carry_out(std::uint64_t client, const RemoveOutput& command);
  Answer carry_out(std::uint64_t client, const Record& command);
  Answer carry_out(std::uint64_t client, const Forget& command);
  Answer carry_out(std::uint64_t client, const Pictures& command);
  Answer carry_out(std::uint64_t client, const Poses& command);
  Answer carry_out(std::uint64_t client, const Drawn& command);
  Answer carry_out(std::uint64_t client, const Ping& command);
  LiveSession& session() const;
  Answer outputs_changed(bool known, const std::string& url) const;

  Recorder& recorder_;
  SenderList& senders_;
  Clock clock_;
  Hooks hooks_;
  std::atomic<LiveSession*> session_ = nullptr;
  mutable std::mutex mutex_;  ///< of what follows
  LatencyRecord latency_;
};

}  // namespace telemime
