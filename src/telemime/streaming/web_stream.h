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

/// The addresses of a connection. One of IPv4 is written as such, also on a socket of IPv6.
boost::asio::ip::address local_address(const boost::asio::ip::tcp::socket& socket);
boost::asio::ip::address remote_address(const boost::asio::ip::tcp::socket& socket);

/// What a server of TLS (1.2 or newer) shows and proves: its certificate, with those in between behind it,
/// and its key without a password, both in PEM form. Throws Error(usage) that says which of them cannot be
/// used and why.
std::shared_ptr<boost::asio::ssl::context> web_tls(const std::filesystem::path& certificate,
                                                   const std::filesystem::path& key);

/// A connection of the server's, plain or by TLS, as Beast reads and writes it. The time limit is that of
/// the TCP connection below.
class WebStream {
 public:
  using executor_type = boost::beast::tcp_stream::executor_type;

  /// `tls` may be null: plain.
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
  void close() { tcp_.close(); }
  /// Of one that is plain; nothing is left here.
  boost::beast::tcp_stream take() { return std::move(tcp_); }

  /// For one by TLS: before anything is read, and when nothing more is written.
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
