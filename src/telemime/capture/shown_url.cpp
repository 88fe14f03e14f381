// SPDX-License-Identifier: Apache-2.0
#include "telemime/capture/shown_url.h"

#include <algorithm>
#include <string_view>

namespace telemime {
namespace {

bool is_port(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

/// Where the host begins, from the position behind "://" on.
std::size_t host_of(const std::string& url, std::size_t start) {
  const std::string_view authority(url.data() + start,
                                   std::min(url.find_first_of("/?#", start), url.size()) - start);
  if (const std::size_t at = authority.rfind('@'); at != std::string_view::npos) {
    return start + at + 1;
  }
  // A password may contain "/", "?" or "#" that should have been encoded; then no port follows the colon.
  const std::size_t colon = authority.find(':');
  if (colon == std::string_view::npos || authority.front() == '[' || is_port(authority.substr(colon + 1))) {
    return start;
  }
  const std::size_t at = url.rfind('@');
  return at == std::string::npos || at < start ? start : at + 1;
}

}  // namespace

std::string shown_url(const std::string& url) {
  const std::size_t scheme = url.find("://");
  if (scheme == std::string::npos) {
    return url;
  }
  const std::size_t start = scheme + 3;
  const std::size_t host = host_of(url, start);
  std::string place = url.substr(host, std::min(url.find_first_of("?#", host), url.size()) - host);
  if (const std::size_t assignment = place.find('='); assignment != std::string::npos) {
    const std::size_t slash = place.rfind('/', assignment);
    place.erase(slash == std::string::npos ? 0 : slash + 1);
  }
  return url.substr(0, start) + place;
}

}  // namespace telemime
