// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/ssl/stream.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>

namespace telemime {

/// The addresses of a connection. An IPv4 address is written as such, even on an IPv6 socket.
boost::asio::ip::address local_address(const boost::asio::ip::tcp::socket& socket);
boost::asio::ip::address remote_address(const boost::asio::ip::tcp::socket& socket);

/// The TLS context (1.2 or newer) of a server: its certificate followed by the intermediate ones, and its key
/// without a password, both as PEM files. Throws Error(usage) that says which of them cannot be used and why.
std::shared_ptr<boost::asio::ssl::context> web_tls(const std::filesystem::path& certificate,
                                                   const std::filesystem::path& key);

/// A plain or TLS connection of the server, for reading and writing with Beast. The time limit is that of the
/// underlying TCP connection.
class WebStream {
 public:
  using executor_type = boost::beast::tcp_stream::executor_type;

  /// `tls` may be null for a plain connection.
  WebStream(boost::asio::ip::tcp::socket socket, std::shared_ptr<boost::asio::ssl::context> tls)
      : tcp_(std::move(socket)), context_(std::move(tls)) {
    if (context_) {
      tls_.emplace(tcp_, *context_);
    }
  }
  WebStream(const WebStream&) = delete;
  WebStream& operator=(const WebStream&) = delete;
  ~WebStream() = default;

  bool secure() const { return tls_.has_value(); }
  executor_type get_executor() { return tcp_.get_executor(); }
  boost::asio::ip::tcp::socket& socket() { return tcp_.socket(); }
  void expires_after(std::chrono::nanoseconds time) { tcp_.expires_after(time); }
  void expires_never() { tcp_.expires_never(); }
  /// Moves the stream out of a plain connection.
  boost::beast::tcp_stream take() { return std::move(tcp_); }

  /// For TLS: before the first read, and after the last write.
  template <class Handler>
  void async_handshake(Handler&& handler) {
    tls_->async_handshake(boost::asio::ssl::stream_base::server, std::forward<Handler>(handler));
  }
  template <class Handler>
  void async_shutdown(Handler&& handler) {
    tls_->async_shutdown(std::forward<Handler>(handler));
  }

  template <class Buffers, class Handler>
  void async_read_some(const Buffers& buffers, Handler&& handler) {
    if (tls_) {
      tls_->async_read_some(buffers, std::forward<Handler>(handler));
    } else {
      tcp_.async_read_some(buffers, std::forward<Handler>(handler));
    }
  }
  template <class Buffers, class Handler>
  void async_write_some(const Buffers& buffers, Handler&& handler) {
    if (tls_) {
      tls_->async_write_some(buffers, std::forward<Handler>(handler));
    } else {
      tcp_.async_write_some(buffers, std::forward<Handler>(handler));
    }
  }

 private:
  boost::beast::tcp_stream tcp_;
  std::shared_ptr<boost::asio::ssl::context> context_;
  std::optional<boost::asio::ssl::stream<boost::beast::tcp_stream&>> tls_;
};

}  // namespace telemime
