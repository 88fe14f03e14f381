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

/// The request of `telemime live`.
struct LiveRequest {
  TrackRequest request;
  bool camera = true;             ///< or a stream, not a file: somebody can be asked to leave the image
  bool ends = false;              ///< the end of the input is not a failure: a file, also on a server
  bool guided = true;             ///< wait for the empty room
  double page_wait = 60.0;        ///< s without an open page, after which tracking starts without the guide
  WebServerOptions web;           ///< where the page is served
  std::filesystem::path avatars;  ///< folder of the page's avatars; empty: none
  std::filesystem::path more_avatars;  ///< a second one, of the user
  SenderKinds sender_kinds = telemime::sender_kinds();
  std::vector<std::string> send;         ///< URLs of senders
  std::filesystem::path virtual_camera;  ///< device for other programs (virtual_camera.h); empty: none
  std::filesystem::path settings;        ///< file of the settings for later runs; empty: nothing is saved
  bool resume_outputs = false;           ///< turn on the outputs of earlier runs at once
  std::filesystem::path recordings = "telemime-recordings";
  std::string version;
};

/// Why a run has ended by itself.
struct LiveFailure {
  bool input = false;  ///< the input cannot be read any more; otherwise an internal failure
  std::string words;
};

/// State of a live run, for the console.
struct LiveReport {
  LiveState state;
  std::optional<LatencyRecord::Summary>
      latency;       ///< from the camera to the drawn avatar, as measured by pages; ms
  double cpu = 0.0;  ///< cores used by this process since its start
  std::vector<SenderStatus> outputs;
  std::optional<LiveFailure> failure;  ///< never at the normal end of an input
  std::size_t pages = 0;               ///< open pages
  std::int64_t poses = 0;              ///< messages made for pages; only while a page gets them
  std::int64_t pictures = 0;           ///< the same
};

/// A live run with the page, senders and recordings. It runs in its own threads from the constructor to the
/// destructor.
class LiveProgram {
 public:
  using Message = std::function<void(MessageLevel, const std::string&)>;

  /// `message`: text for the console, from any thread. Throws Error for invalid settings or URLs of senders
  /// and for a port that is taken.
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

/// The URL of the page for a browser on this computer.
std::string page_url(const WebServerOptions& web, std::uint16_t port);

}  // namespace telemime
