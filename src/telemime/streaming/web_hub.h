// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/ssl/context.hpp>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "telemime/streaming/web_origin.h"
#include "telemime/streaming/web_queue.h"
#include "telemime/streaming/web_server.h"

namespace telemime {

class WebClient;

/// Posts work from other threads to the server's thread, as long as it runs.
class WebDoor {
 public:
  explicit WebDoor(boost::asio::io_context& io) : io_(&io) {}

  /// From any thread, at any time.
  void post(std::function<void()> work) {
    const std::lock_guard lock(mutex_);
    if (io_ != nullptr) {
      boost::asio::post(*io_, std::move(work));
    }
  }
  /// The server ends: work that is posted later is discarded.
  void close() {
    const std::lock_guard lock(mutex_);
    io_ = nullptr;
  }

 private:
  std::mutex mutex_;
  boost::asio::io_context* io_;
};

/// State that the connections of one server share. For the server's thread only, unless stated otherwise.
class WebHub {
 public:
  /// `names`: host names of the server, with its actual port. `tls` may be null.
  WebHub(const WebServerOptions& options, WebHandlers handlers, WebNames names, std::shared_ptr<WebDoor> door,
         std::shared_ptr<boost::asio::ssl::context> tls);

  const WebServerOptions& options() const { return options_; }
  const WebHandlers& handlers() const { return handlers_; }
  const WebNames& names() const { return names_; }
  const std::shared_ptr<WebDoor>& door() const { return door_; }
  const std::shared_ptr<boost::asio::ssl::context>& tls() const { return tls_; }

  /// A token that a connection holds while it is open; nothing if too many are open.
  std::shared_ptr<void> ticket();
  /// True if too many connections are open to keep them after a request.
  bool crowded() const;

  /// Keeps a connection alive that waits for other threads, until it is released or the server ends.
  void hold(const std::shared_ptr<void>& connection) { held_.insert(connection); }
  /// False: it is not held.
  bool let_go(const std::shared_ptr<void>& connection) { return held_.erase(connection) > 0; }

  /// Registers a client and returns its number; nothing if there are too many. `from_here`: it is connected
  /// over loopback.
  std::optional<std::uint64_t> join(const std::shared_ptr<WebClient>& client, bool from_here);
  /// Removes a client, if it is still registered.
  void leave(std::uint64_t id);
  /// Calls leave() for all.
  void leave_all();

  /// Calls the handlers; their exceptions become a `message` to the client.
  std::vector<std::string> greeting(std::uint64_t id) const;
  std::optional<std::string> answer(std::uint64_t id, std::string_view text) const;

  /// Queues a message; from any thread. If it returns true, drain() must be called.
  bool put(WebMessage message);
  /// Passes the queued messages to the clients.
  void drain();
  void set_topic(std::uint64_t client, int topic, bool on);

  std::size_t clients() const;                 ///< from any thread
  bool wanted(int topic) const;                ///< from any thread
  bool from_here(std::uint64_t client) const;  ///< from any thread; false after it left

 private:
  const WebServerOptions options_;
  const WebHandlers handlers_;
  const WebNames names_;
  const std::shared_ptr<WebDoor> door_;
  const std::shared_ptr<boost::asio::ssl::context> tls_;
  std::set<std::shared_ptr<void>> held_;
  std::map<std::uint64_t, std::weak_ptr<WebClient>> clients_;
  std::uint64_t last_id_ = 0;
  std::shared_ptr<std::size_t> connections_ = std::make_shared<std::size_t>(0);

  mutable std::mutex mutex_;                           ///< guards the members below
  std::map<std::uint64_t, std::set<int>> turned_off_;  ///< topics, of each client
  std::set<std::uint64_t> from_here_;                  ///< clients of this computer
  WebQueue inbox_{std::numeric_limits<std::size_t>::max()};
  bool drain_is_due_ = false;
};

}  // namespace telemime
