// SPDX-License-Identifier: Apache-2.0
#include "meeting/hosting/ports.h"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <memory>

#include "telemime/core/errors.h"

namespace telemime::meeting {

std::optional<std::uint16_t> free_port(const std::string& address, std::uint16_t port) {
  sockaddr_in where{};
  where.sin_family = AF_INET;
  where.sin_port = htons(port);
  if (::inet_pton(AF_INET, address.c_str(), &where.sin_addr) != 1) {
    throw Error(ErrorKind::usage, "'" + address + "' is no address that a room can be opened at",
                "Write numbers: 127.0.0.1 is for this computer alone, 0.0.0.0 for whoever can reach it.");
  }
  const int descriptor = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const int yes = 1;  // as the broker: a port whose last connections are still dying is free
  ::setsockopt(descriptor, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  const bool bound = ::bind(descriptor, reinterpret_cast<const sockaddr*>(&where), sizeof where) == 0;
  const int error = bound ? 0 : errno;
  const bool free = bound && ::listen(descriptor, 1) == 0;
  socklen_t size = sizeof where;
  ::getsockname(descriptor, reinterpret_cast<sockaddr*>(&where), &size);
  ::close(descriptor);
  if (error == EADDRNOTAVAIL) {
    throw Error(ErrorKind::usage, "this computer has no address " + address,
                "127.0.0.1 is for this computer alone, 0.0.0.0 for whoever can reach it.");
  }
  if (error == EACCES) {
    throw Error(ErrorKind::output, "port " + std::to_string(port) + " is not for ordinary users",
                "Choose one above 1023.");
  }
  return free ? std::optional(ntohs(where.sin_port)) : std::nullopt;
}

std::string own_address() {
  ifaddrs* list = nullptr;
  if (::getifaddrs(&list) != 0) {
    return "127.0.0.1";
  }
  const std::unique_ptr<ifaddrs, decltype(&::freeifaddrs)> owner(list, ::freeifaddrs);
  for (const ifaddrs* entry = list; entry != nullptr; entry = entry->ifa_next) {
    const bool fits = entry->ifa_addr != nullptr && entry->ifa_addr->sa_family == AF_INET &&
                      (entry->ifa_flags & IFF_LOOPBACK) == 0 && (entry->ifa_flags & IFF_UP) != 0;
    std::array<char, INET_ADDRSTRLEN> text{};
    if (fits && ::inet_ntop(AF_INET, &reinterpret_cast<const sockaddr_in*>(entry->ifa_addr)->sin_addr,
                            text.data(), text.size()) != nullptr) {
      return text.data();
    }
  }
  return "127.0.0.1";
}

}  // namespace telemime::meeting
