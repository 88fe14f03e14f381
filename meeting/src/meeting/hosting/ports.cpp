// SPDX-License-Identifier: Apache-2.0
#include "meeting/hosting/ports.h"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>

#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <memory>

#include "telemime/core/errors.h"

namespace telemime::meeting {
namespace {

namespace errc = boost::system::errc;
using boost::asio::ip::tcp;

constexpr const char* kAddresses = "127.0.0.1 is this computer only, 0.0.0.0 all networks.";

}  // namespace

std::optional<std::uint16_t> free_port(const std::string& address, std::uint16_t port) {
  boost::system::error_code error;
  const auto where = boost::asio::ip::make_address_v4(address, error);
  if (error) {
    throw Error(ErrorKind::usage, "'" + address + "' is not an IPv4 address", kAddresses);
  }
  boost::asio::io_context io;
  tcp::acceptor acceptor(io, tcp::v4());
  // Like the broker, which can use a port whose last connections are still closing.
  acceptor.set_option(tcp::acceptor::reuse_address(true));
  acceptor.bind({where, port}, error);
  if (error == errc::address_not_available) {
    throw Error(ErrorKind::usage, "this computer does not have the address " + address, kAddresses);
  }
  if (error == errc::permission_denied) {
    throw Error(ErrorKind::output, "port " + std::to_string(port) + " is reserved for the system",
                "Choose a port above 1023.");
  }
  if (!error) {
    acceptor.listen(1, error);
  }
  return error ? std::nullopt : std::optional(acceptor.local_endpoint().port());
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
