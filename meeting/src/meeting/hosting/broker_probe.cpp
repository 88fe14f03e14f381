// SPDX-License-Identifier: Apache-2.0
#include "meeting/hosting/broker_probe.h"

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <string_view>

namespace telemime::meeting {
namespace {

constexpr int kPatience = 1000;  // ms
constexpr std::size_t kLongestText = 1000;

void put_text(std::string& packet, std::string_view text) {
  packet += static_cast<char>(text.size() >> 8U);
  packet += static_cast<char>(text.size() & 0xFFU);
  packet += text;
}

/// CONNECT of MQTT 3.1.1 (section 3.1), without an id, as somebody who leaves at once.
std::string connect_packet(const std::string& user, const std::string& password) {
  std::string body;
  put_text(body, "MQTT");
  body += '\x04';  // level
  body += '\xC2';  // user, password, clean session
  body.append({'\0', '\x0A'});
  put_text(body, "");
  put_text(body, user);
  put_text(body, password);
  std::string packet = "\x10";
  std::size_t size = body.size();
  do {
    const std::size_t rest = size / 128;
    packet += static_cast<char>((size % 128) | (rest > 0 ? 128U : 0U));
    size = rest;
  } while (size > 0);
  return packet + body;
}

class Socket {
 public:
  Socket() : descriptor_(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)) {}
  ~Socket() {
    if (descriptor_ >= 0) {
      ::close(descriptor_);
    }
  }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;
  int get() const { return descriptor_; }

 private:
  int descriptor_;
};

}  // namespace

BrokerAnswer ask_broker(const std::filesystem::path& socket, const std::string& user,
                        const std::string& password) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string path = socket.string();
  if (path.size() >= sizeof address.sun_path || user.size() > kLongestText ||
      password.size() > kLongestText) {
    return BrokerAnswer::silent;
  }
  std::memcpy(address.sun_path, path.c_str(), path.size() + 1);
  const Socket connection;
  if (connection.get() < 0 ||
      ::connect(connection.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    return BrokerAnswer::silent;
  }
  const std::string packet = connect_packet(user, password);
  if (::send(connection.get(), packet.data(), packet.size(), MSG_NOSIGNAL) !=
      static_cast<ssize_t>(packet.size())) {
    return BrokerAnswer::silent;
  }
  std::array<char, 4> answer{};  // CONNACK (section 3.2)
  std::size_t size = 0;
  while (size < answer.size()) {
    pollfd entry{connection.get(), POLLIN, 0};
    if (::poll(&entry, 1, kPatience) <= 0) {
      return BrokerAnswer::silent;
    }
    const ssize_t count = ::recv(connection.get(), answer.data() + size, answer.size() - size, 0);
    if (count <= 0) {
      return BrokerAnswer::silent;
    }
    size += static_cast<std::size_t>(count);
  }
  if (answer[0] != '\x20') {
    return BrokerAnswer::silent;
  }
  constexpr std::string_view goodbye("\xE0\0", 2);  // DISCONNECT
  ::send(connection.get(), goodbye.data(), goodbye.size(), MSG_NOSIGNAL);
  return answer[3] == 0 ? BrokerAnswer::accepted : BrokerAnswer::refused;
}

}  // namespace telemime::meeting
