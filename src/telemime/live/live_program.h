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
#include "telemime/streaming/sender.h"
#include "telemime/streaming/web_server.h"

namespace telemime {

/// What `telemime live` is asked to do.
struct LiveRequest {
  TrackRequest request;
  bool ends = false;              ///< the input has an end, which is no failure: a file, also one on a server
  bool guided = true;             ///< wait for the empty room
  double page_wait = 60.0;        ///< s without a page to ask for it, until the start goes on without
  WebServerOptions web;           ///< where the page is served
  std::filesystem::path avatars;  ///< folder of the page's avatars; empty: none
  SenderKinds sender_kinds = telemime::sender_kinds();
  std::vector<std::string> send;   ///< URLs of senders
  std::filesystem::path settings;  ///< file of what is kept for later runs; empty: nothing is
  bool resume_outputs = false;     ///< send to the outputs kept by earlier runs at once
  std::filesystem::path recordings = "telemime-recordings";
  std::string version;
};

/// Why a run has ended that nobody asked to end.
struct LiveFailure {
  bool input = false;  ///< the input cannot be read any more; else something inside failed
  std::string words;
};

/// How a live run is doing, for the console.
struct LiveReport {
  LiveState state;
  std::optional<LatencyRecord::Summary>
      latency;       ///< from the camera to the avatar drawn, as pages measured; ms
  double cpu = 0.0;  ///< cores that this process used since it began
  std::vector<SenderStatus> outputs;
  std::optional<LiveFailure> failure;  ///< never at the end of an input that has one
  std::size_t pages = 0;               ///< that are open
  std::int64_t poses = 0;              ///< messages made for pages; none are when nobody gets them
  std::int64_t pictures = 0;           ///< the same
};

/// A live run with everything around it: the page, senders, recordings. It runs in threads of its own from
/// the constructor to the destructor.
class LiveProgram {
 public:
  using Message = std::function<void(MessageLevel, const std::string&)>;

  /// `message`: words for the console, from any thread. Throws Error for settings, senders' URLs, a port that
  /// is taken.
  LiveProgram(const LiveRequest& options, std::unique_ptr<Source> source, Message message);
  LiveProgram(const LiveProgram&) = delete;
  LiveProgram& operator=(const LiveProgram&) = delete;
  ~LiveProgram();

  std::uint16_t port() const;
  LiveReport report() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Where a browser on this computer finds the page that is served so, at that port.
std::string page_url(const WebServerOptions& web, std::uint16_t port);

}  // namespace telemime
