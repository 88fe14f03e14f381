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

/// Executes the commands of the pages. Only pages on this computer change the saved settings; a page
/// elsewhere changes this run only. Call it from the server's thread unless stated otherwise.
class LiveAnswers {
 public:
  struct Hooks {
    std::function<void(std::uint64_t client, int topic, bool on)> topic;  ///< WebServer::set_topic
    std::function<void()> changed;                                        ///< the status has changed
    std::function<bool(std::uint64_t client)> from_here;                  ///< WebServer::from_here
    std::function<void(const std::string& url)> keep;                     ///< SavedOutputs::keep
    std::function<void(const std::string& url)> forget;                   ///< SavedOutputs::forget
  };
  LiveAnswers(Recorder& recorder, SenderList& senders, Clock clock, Hooks hooks)
      : recorder_(recorder), senders_(senders), clock_(std::move(clock)), hooks_(std::move(hooks)) {}

  /// Sets the session, which must outlive the server. Thread-safe.
  void begin(LiveSession& session) { session_ = &session; }

  /// Executes a page's message and returns the reply, if there is one.
  std::optional<std::string> operator()(std::uint64_t client, std::string_view text);

  /// Latency from camera to drawn avatar, ms, as measured by the pages. Thread-safe.
  std::optional<LatencyRecord::Summary> latency() const;

 private:
  using Answer = std::optional<std::string>;
  Answer carry_out(std::uint64_t client, const Command& command);
  Answer add_output(std::uint64_t client, const std::string& url);
  Answer changed(bool known, const std::string& url) const;
  LiveSession& session() const;

  Recorder& recorder_;
  SenderList& senders_;
  Clock clock_;
  Hooks hooks_;
  std::atomic<LiveSession*> session_ = nullptr;
  mutable std::mutex mutex_;  ///< guards latency_
  LatencyRecord latency_;
};

}  // namespace telemime
