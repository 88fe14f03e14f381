// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
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

/// Hands work of other threads to the server's thread, as long as there is one.
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
  /// The server ends: what is posted from now on is forgotten.
  void close() {
    const std::lock_guard lock(mutex_);
    io_ = nullptr;
  }

 private:
  std::mutex mutex_;
  boost::asio::io_context* io_;
};

/// What the connections of one server share. Unless said otherwise, for the server's thread only.
class WebHub {
 public:
  /// `names`: under which the server may be called, with the port that it got.
  /// `tls` may be null.
  WebHub(const WebServerOptions& options, WebHandlers handlers, WebNames names, std::shared_ptr<WebDoor> door,
         std::shared_ptr<boost::asio::ssl::context> tls);

  const WebServerOptions& options() const { return options_; }
  const WebHandlers& handlers() const { return handlers_; }
  const WebNames& names() const { return names_; }
  const std::shared_ptr<WebDoor>& door() const { return door_; }
  const std::shared_ptr<boost::asio::ssl::context>& tls() const { return tls_; }

  /// To be kept by a connection as long as it is open; nothing when too many are.
  std::shared_ptr<void> ticket();
  /// So many are open that none is to be kept for another request.
  bool crowded() const;

  /// Keeps a connection that waits for other threads, until it is let go or the server ends.
  void hold(const std::shared_ptr<void>& connection) { held_.insert(connection); }
  /// False: it is not held.
  bool let_go(const std::shared_ptr<void>& connection) { return held_.erase(connection) > 0; }

  /// A number for the client, which takes part from now on; nothing when too many do. `from_here`: its
  /// connection came over loopback.
  std::optional<std::uint64_t> join(const std::shared_ptr<WebClient>& client, bool from_here);
  /// Tells the handlers, once.
  void leave(std::uint64_t id);
  /// leave() for all.
  void leave_all();

  /// The handlers, with what they throw as a `message` to the client.
  std::vector<std::string> greeting(std::uint64_t id) const;
  std::optional<std::string> answer(std::uint64_t id, std::string_view text) const;

  /// From any thread. True: drain() must be called.
  bool put(WebMessage message);
  /// Gives what was put to the clients.
  void drain();
  void set_topic(std::uint64_t client, int topic, bool on);

  std::size_t clients() const { return count_; }  ///< from any thread
  bool wanted(int topic) const;                   ///< from any thread
  bool from_here(std::uint64_t client) const;     ///< from any thread; false when it is gone

 private:
  const WebServerOptions options_;
  const WebHandlers handlers_;
  const WebNames names_;
  const std::shared_ptr<WebDoor> door_;
  const std::shared_ptr<boost::asio::ssl::context> tls_;
  std::set<std::shared_ptr<void>> held_;
  std::map<std::uint64_t, std::weak_ptr<WebClient>> clients_;
  std::uint64_t last_id_ = 0;
  std::atomic<std::size_t> count_ = 0;
  std::shared_ptr<std::size_t> connections_ = std::make_shared<std::size_t>(0);

  mutable std::mutex mutex_;                           ///< of what follows
  std::map<std::uint64_t, std::set<int>> turned_off_;  ///< topics, of each client
  std::set<std::uint64_t> from_here_;                  ///< clients of this computer
  WebQueue inbox_{std::numeric_limits<std::size_t>::max()};
  bool drain_is_due_ = false;
};

}  // namespace telemime
