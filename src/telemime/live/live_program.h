// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "telemime/capture/source.h"
#include "telemime/live/live_session.h"
#include "telemime/network/sender.h"
#include "telemime/network/web_server.h"

namespace telemime {

/// What `telemime live` is asked to do.
struct LiveRequest {
  TrackRequest request;
  bool guided = true;             ///< wait for the empty room, as long as a page is open to ask for it
  WebServerOptions web;           ///< where the page is served
  std::vector<std::string> send;  ///< URLs of senders
  std::filesystem::path recordings = "telemime-recordings";
  std::string version;
};

/// How a live run is doing, for the console.
struct LiveReport {
  LiveState state;
  std::optional<LatencyRecord::Summary>
      latency;       ///< from the camera to the avatar drawn, as pages measured; ms
  double cpu = 0.0;  ///< cores that this process used since it began
  std::vector<SenderStatus> outputs;
};

/// A live run with everything around it: the page, senders, recordings. It runs in threads of its own from
/// the constructor to the destructor.
class LiveProgram {
 public:
  /// `message`: words for the console, from any thread. Throws Error for settings, senders' URLs, a port that
  /// is taken.
  LiveProgram(const LiveRequest& options, std::unique_ptr<Source> source,
              std::function<void(const std::string&)> message);
  LiveProgram(const LiveProgram&) = delete;
  LiveProgram& operator=(const LiveProgram&) = delete;
  ~LiveProgram();

  std::uint16_t port() const;
  LiveReport report() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace telemime
