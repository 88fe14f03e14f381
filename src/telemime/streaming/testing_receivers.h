// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>

/// The other end of the senders, for their tests: plain sockets of the system on loopback. Nothing of the
/// senders' own code is used here.
namespace telemime::testing_receivers {

inline constexpr double kTaken = 1234.5;  ///< ms, of frames whose time is of no matter
inline constexpr int kPatience = 20000;   ///< ms: how long a test waits for what must come

/// A file descriptor that closes itself.
class Fd {
 public:
  explicit Fd(int fd) : fd_(fd) { EXPECT_GE(fd, 0); }
  Fd(Fd&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Fd& operator=(Fd&&) = delete;
  ~Fd() { close(); }
  void close() {
    if (fd_ >= 0) {
      ::close(std::exchange(fd_, -1));
    }
  }
  int get() const { return fd_; }
  /// Whether there is something to read, or the end, within `ms`.
  bool readable(int ms) const {
    pollfd entry{fd_, POLLIN, 0};
    return ::poll(&entry, 1, ms) > 0;
  }

 private:
  int fd_;
};

inline sockaddr_in loopback(std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

inline void bind_to(int fd, std::uint16_t port, in_addr_t address = INADDR_LOOPBACK) {
  const int yes = 1;
  ::setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
  sockaddr_in where = loopback(port);
  where.sin_addr.s_addr = htonl(address);
  ASSERT_EQ(::bind(fd, reinterpret_cast<const sockaddr*>(&where), sizeof(where)), 0);
}

inline std::uint16_t port_of(int fd) {
  sockaddr_in where{};
  socklen_t size = sizeof(where);
  EXPECT_EQ(::getsockname(fd, reinterpret_cast<sockaddr*>(&where), &size), 0);
  return ntohs(where.sin_port);
}

/// Receives datagrams on loopback.
class UdpReceiver {
 public:
  explicit UdpReceiver(std::uint16_t port = 0) : fd_(::socket(AF_INET, SOCK_DGRAM, 0)) {
    bind_to(fd_.get(), port);
  }
  /// Of a multicast group, by the loopback interface.
  explicit UdpReceiver(const std::string& group) : fd_(::socket(AF_INET, SOCK_DGRAM, 0)) {
    bind_to(fd_.get(), 0, INADDR_ANY);
    ip_mreq wish{};
    wish.imr_multiaddr.s_addr = ::inet_addr(group.c_str());
    wish.imr_interface.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(::setsockopt(fd_.get(), IPPROTO_IP, IP_ADD_MEMBERSHIP, &wish, sizeof(wish)), 0);
  }
  std::uint16_t port() const { return port_of(fd_.get()); }
  /// The next datagram; nothing when none comes within `ms`.
  std::optional<std::string> receive(int ms = kPatience) {
    std::string bytes(65536, '\0');
    if (!fd_.readable(ms)) {
      return std::nullopt;
    }
    const ssize_t size = ::recv(fd_.get(), bytes.data(), bytes.size(), 0);
    bytes.resize(size < 0 ? 0 : static_cast<std::size_t>(size));
    return bytes;
  }

 private:
  Fd fd_;
};

/// One end of a TCP connection.
class TcpPeer {
 public:
  explicit TcpPeer(int fd) : fd_(fd) {}
  /// Connects to a port of this computer.
  static TcpPeer to(std::uint16_t port) {
    TcpPeer peer(::socket(AF_INET, SOCK_STREAM, 0));
    const sockaddr_in where = loopback(port);
    EXPECT_EQ(::connect(peer.fd_.get(), reinterpret_cast<const sockaddr*>(&where), sizeof(where)), 0);
    return peer;
  }
  bool send(const std::string& bytes) {
    return ::send(fd_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(bytes.size());
  }
  /// The next line without its end; nothing at the end of the stream or after `ms` without a byte.
  std::optional<std::string> line(int ms = kPatience) {
    std::size_t end = 0;
    while ((end = bytes_.find('\n')) == std::string::npos) {
      if (!fill(ms)) {
        return std::nullopt;
      }
    }
    const std::string found = bytes_.substr(0, end);
    bytes_.erase(0, end + 1);
    return found;
  }
  /// Reads until the other end closes: whether it does.
  bool ends(int ms = kPatience) {
    while (fill(ms)) {
    }
    return ended_;
  }
  void close() { fd_.close(); }
  /// Closes with a reset.
  void reset() {
    const linger at_once{1, 0};
    ::setsockopt(fd_.get(), SOL_SOCKET, SO_LINGER, &at_once, sizeof(at_once));
    fd_.close();
  }
  /// Says that nothing more will be sent; reading goes on.
  void shut_own_direction() const { ::shutdown(fd_.get(), SHUT_WR); }

 private:
  bool fill(int ms) {
    if (!fd_.readable(ms)) {
      return false;
    }
    std::string more(4096, '\0');
    const ssize_t size = ::recv(fd_.get(), more.data(), more.size(), 0);
    ended_ = size <= 0;
    bytes_.append(more, 0, ended_ ? 0 : static_cast<std::size_t>(size));
    return !ended_;
  }
  Fd fd_;
  std::string bytes_;
  bool ended_ = false;
};

/// Listens for TCP connections on loopback.
class TcpListener {
 public:
  explicit TcpListener(std::uint16_t port = 0, int receive_buffer = 0, int backlog = 8)
      : fd_(::socket(AF_INET, SOCK_STREAM, 0)) {
    if (receive_buffer > 0) {
      ::setsockopt(fd_.get(), SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof(receive_buffer));
    }
    bind_to(fd_.get(), port);
    EXPECT_EQ(::listen(fd_.get(), backlog), 0);
  }
  std::uint16_t port() const { return port_of(fd_.get()); }
  bool somebody_waits() const { return fd_.readable(0); }
  TcpPeer accept() {
    EXPECT_TRUE(fd_.readable(kPatience)) << "nobody has connected";
    return TcpPeer(::accept(fd_.get(), nullptr, nullptr));
  }

 private:
  Fd fd_;
};

/// A port that was free a moment ago, and that nobody listens at.
inline std::uint16_t free_port(int type = SOCK_STREAM) {
  const Fd fd(::socket(AF_INET, type, 0));
  bind_to(fd.get(), 0);
  return port_of(fd.get());
}

/// True as soon as the condition holds; false when that takes longer than any test should.
inline bool comes_true(const std::function<bool()>& condition) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) {
      return false;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

/// Destroys it: whether that ends, and not only when some time limit of the network has passed.
template <class T>
bool ends_at_once(std::unique_ptr<T> object) {
  auto end = std::async(std::launch::async, [gone = std::move(object)]() mutable { gone.reset(); });
  return end.wait_for(std::chrono::seconds(2)) == std::future_status::ready;
}

}  // namespace telemime::testing_receivers
