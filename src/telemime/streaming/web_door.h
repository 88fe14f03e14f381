// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <functional>
#include <mutex>
#include <utility>

namespace telemime {

/// By which other threads hand work to the server's thread, as long as there is one.
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

}  // namespace telemime
