// SPDX-License-Identifier: Apache-2.0
#include "telemime/streaming/resolve.h"

#include <netdb.h>

#include <array>
#include <boost/asio/ip/address.hpp>
#include <future>
#include <memory>
#include <thread>

namespace telemime {
namespace {

constexpr std::chrono::milliseconds kLongestLookup{30000};

}  // namespace

std::vector<std::string> system_lookup(const std::string& host) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;  // one entry for each address, not one for each protocol
  addrinfo* found = nullptr;
  const int error = ::getaddrinfo(host.c_str(), nullptr, &hints, &found);
  if (error != 0) {
    throw LinkBroken("no computer named \"" + host + "\" is known (" + ::gai_strerror(error) + ")");
  }
  const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> owner(found, ::freeaddrinfo);
  std::vector<std::string> ipv4;
  std::vector<std::string> others;
  for (const addrinfo* entry = found; entry != nullptr; entry = entry->ai_next) {
    std::array<char, NI_MAXHOST> text{};
    if (::getnameinfo(entry->ai_addr, entry->ai_addrlen, text.data(), text.size(), nullptr, 0,
                      NI_NUMERICHOST) == 0) {
      (entry->ai_family == AF_INET ? ipv4 : others).emplace_back(text.data());
    }
  }
  ipv4.insert(ipv4.end(), others.begin(), others.end());
  return ipv4;
}

std::vector<std::string> resolve(SendLoop& loop, const std::string& host, const Lookup& lookup) {
  boost::system::error_code not_an_address;
  boost::asio::ip::make_address(host, not_an_address);
  if (!not_an_address) {
    return {host};
  }
  // The thread may outlive the sender: it shares nothing but the promise.
  auto promise = std::make_shared<std::promise<std::vector<std::string>>>();
  std::future<std::vector<std::string>> addresses = promise->get_future();
  std::thread([promise, host, lookup, wake = loop.waker()] {
    try {
      promise->set_value(lookup(host));
    } catch (...) {
      promise->set_exception(std::current_exception());
    }
    wake();
  }).detach();
  const auto ready = [&] { return addresses.wait_for(std::chrono::seconds(0)) == std::future_status::ready; };
  if (!loop.wait(ready, kLongestLookup)) {
    throw LinkBroken("the name \"" + host + "\" cannot be looked up: the name server does not respond");
  }
  std::vector<std::string> found = addresses.get();
  if (found.empty()) {
    throw LinkBroken("no computer named \"" + host + "\" is known");
  }
  return found;
}

}  // namespace telemime
