// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <netdb.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "telemime/streaming/testing_receivers.h"
#include "telemime/streaming/web_server.h"

namespace telemime {

using testing_receivers::comes_true;

struct WebReply {
  int status = 0;
  std::string head;
  std::string body;
  /// The value of a header, as the server spells its name; "" when it is not there.
  std::string header(const std::string& name) const {
    const std::size_t at = head.find("\r\n" + name + ": ");
    const std::size_t start = at + name.size() + 4;
    return at == std::string::npos ? "" : head.substr(start, head.find("\r\n", start) - start);
  }
};

/// A bare TCP connection to a server on this machine. Reading fails the test (by throwing) when nothing comes
/// for too long.
class RawClient {
 public:
  explicit RawClient(std::uint16_t port, const char* address = "127.0.0.1", int receive_buffer = 0) {
    addrinfo hints{};
    hints.ai_flags = AI_NUMERICHOST;
    hints.ai_socktype = SOCK_STREAM;
    addrinfo* found = nullptr;
    if (::getaddrinfo(address, std::to_string(port).c_str(), &hints, &found) != 0) {
      throw std::runtime_error("no address");
    }
    const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> owner(found, ::freeaddrinfo);
    fd_ = ::socket(found->ai_family, SOCK_STREAM, 0);
    if (receive_buffer > 0) {
      ::setsockopt(fd_, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
    }
    const int now = 1;
    ::setsockopt(fd_, IPPROTO_TCP, TCP_NODELAY, &now, sizeof now);
    const timeval limit{60, 0};
    ::setsockopt(fd_, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
    ::setsockopt(fd_, SOL_SOCKET, SO_SNDTIMEO, &limit, sizeof limit);
    if (::connect(fd_, found->ai_addr, found->ai_addrlen) != 0) {
      ::close(fd_);
      throw std::runtime_error("no connection");
    }
  }
  ~RawClient() { ::close(fd_); }
  RawClient(const RawClient&) = delete;
  RawClient& operator=(const RawClient&) = delete;

  /// False: the other side has closed.
  bool send(std::string_view bytes) const {
    while (!bytes.empty()) {
      const ssize_t n = ::send(fd_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (n <= 0) {
        return false;
      }
      bytes.remove_prefix(static_cast<std::size_t>(n));
    }
    return true;
  }
  void end_of_sending() const { ::shutdown(fd_, SHUT_WR); }

  /// Until at least `size` bytes wait in buffer(); false when the other side closes before.
  bool fill(std::size_t size) {
    while (buffer_.size() < size) {
      char part[16 * 1024];
      const ssize_t n = ::recv(fd_, part, sizeof part, 0);
      if (n < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) {
        throw std::runtime_error("the server neither answers nor closes");
      }
      if (n <= 0) {
        return false;
      }
      buffer_.append(part, static_cast<std::size_t>(n));
    }
    return true;
  }
  std::string take(std::size_t size) {
    std::string result = buffer_.substr(0, size);
    buffer_.erase(0, size);
    return result;
  }
  /// All until the other side closes.
  std::string rest() {
    while (fill(buffer_.size() + 1)) {
    }
    return take(buffer_.size());
  }
  /// One HTTP answer; status 0 when the other side closes instead. `head`: it has no body.
  WebReply reply(bool head = false) {
    std::size_t end = std::string::npos;
    while ((end = buffer_.find("\r\n\r\n")) == std::string::npos) {
      if (!fill(buffer_.size() + 1)) {
        return {};
      }
    }
    WebReply result;
    result.head = take(end + 4);
    result.status = std::atoi(result.head.substr(9, 3).c_str());
    const std::size_t size = std::strtoul(result.header("Content-Length").c_str(), nullptr, 10);
    if (!head && fill(size)) {
      result.body = take(size);
    }
    return result;
  }

 private:
  int fd_ = -1;
  std::string buffer_;
};

/// The text of a request. `headers`: further lines, each with its end.
inline std::string request_text(std::uint16_t port, const std::string& target,
                                const std::string& headers = "", const std::string& method = "GET") {
  return method + " " + target + " HTTP/1.1\r\nHost: localhost:" + std::to_string(port) + "\r\n" + headers +
         "\r\n";
}

/// The answer to these exact bytes; status 0 when there is none.
inline WebReply reply_to(std::uint16_t port, const std::string& bytes, bool head = false) {
  RawClient client(port);
  client.send(bytes);
  return client.reply(head);
}

inline WebReply ask(std::uint16_t port, const std::string& target, const std::string& headers = "",
                    const std::string& method = "GET") {
  return reply_to(port, request_text(port, target, headers, method), method == "HEAD");
}

/// Bytes as the server sends them.
inline WebBytes shared(std::string bytes) {
  return std::make_shared<const std::string>(std::move(bytes));
}

/// A server for a test: any free port, and answers to "/" alone unless told otherwise.
inline WebHandlers small_page() {
  WebHandlers handlers;
  handlers.get = [](const std::string& path) -> std::optional<WebContent> {
    if (path != "/") {
      return std::nullopt;
    }
    return WebContent{shared("<p>here</p>"), "text/html", "", false};
  };
  return handlers;
}
inline WebServerOptions any_port() {
  WebServerOptions options;
  options.port = 0;
  return options;
}

}  // namespace telemime
