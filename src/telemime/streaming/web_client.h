// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <cstdint>
#include <memory>

#include "telemime/streaming/web_answer.h"
#include "telemime/streaming/web_hub.h"
#include "telemime/streaming/web_queue.h"

namespace telemime {

/// One open WebSocket, from the upgrade on. It exists as long as one of its operations is in progress. For
/// the server's thread only.
class WebClient : public std::enable_shared_from_this<WebClient> {
 public:
  WebClient(std::shared_ptr<WebHub> hub, std::shared_ptr<void> ticket, boost::beast::tcp_stream stream);
  ~WebClient();
  WebClient(const WebClient&) = delete;
  WebClient& operator=(const WebClient&) = delete;

  void start(const WebRequest& request);
  /// Queues a message; the client is disconnected if too many are waiting.
  void push(WebMessage message);
  void set_topic(int topic, bool on) { queue_.set_topic(topic, on); }

 private:
  using Code = boost::beast::websocket::close_code;
  void opened();
  void read();
  void take();
  void write();
  void write_piece();
  void written(std::size_t bytes);
  /// Closes with a reason; the other side must respond soon.
  void close(Code code, const char* words);
  /// Closes at once.
  void drop();

  std::shared_ptr<WebHub> hub_;
  std::shared_ptr<void> ticket_;
  boost::beast::websocket::stream<boost::beast::tcp_stream> stream_;
  boost::asio::steady_timer stalled_;
  boost::beast::flat_buffer buffer_;
  std::uint64_t id_ = 0;  ///< 0: not registered
  WebQueue queue_;
  WebMessage current_;      ///< what is being written
  std::size_t offset_ = 0;  ///< how much of it was written
  bool writing_ = false;
  bool closing_ = false;
};

}  // namespace telemime
