// SPDX-License-Identifier: Apache-2.0
#include "meeting/hosting/rate_limit.h"

#include <algorithm>
#include <boost/asio/ip/address.hpp>

namespace telemime::meeting {
namespace {

std::string network_of(const std::string& text) {
  boost::system::error_code error;
  const auto address = boost::asio::ip::make_address(text, error);
  if (error || !address.is_v6()) {
    return text;
  }
  auto bytes = address.to_v6().to_bytes();
  std::fill(bytes.begin() + bytes.size() / 2, bytes.end(), static_cast<unsigned char>(0));
  return boost::asio::ip::make_address_v6(bytes).to_string();
}

}  // namespace

RateLimit::Left& RateLimit::of(const std::string& address, double now) {
  const std::string network = network_of(address);
  auto found = left_.find(network);
  if (found == left_.end()) {
    if (left_.size() >= rates_.most_addresses) {
      forget_one();
    }
    found = left_.emplace(network, Left{rates_.tries, rates_.misses, now}).first;
  }
  Left& left = found->second;
  const double passed = std::max(0.0, now - left.at);
  left.tries = std::min(rates_.tries, left.tries + passed * rates_.tries_per_second);
  left.misses = std::min(rates_.misses, left.misses + passed * rates_.misses_per_second);
  left.at = std::max(left.at, now);
  return left;
}

// The one that was heard of least lately.
void RateLimit::forget_one() {
  const auto oldest = std::min_element(
      left_.begin(), left_.end(), [](const auto& a, const auto& b) { return a.second.at < b.second.at; });
  if (oldest != left_.end()) {
    left_.erase(oldest);
  }
}

bool RateLimit::allow(const std::string& address, double now) {
  Left& left = of(address, now);
  if (left.tries < 1.0) {
    return false;
  }
  left.tries -= 1.0;
  return true;
}

bool RateLimit::miss(const std::string& address, double now) {
  Left& left = of(address, now);
  if (left.misses < 1.0) {
    return false;
  }
  left.misses -= 1.0;
  return true;
}

}  // namespace telemime::meeting
