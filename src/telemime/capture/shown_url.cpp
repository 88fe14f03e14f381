// SPDX-License-Identifier: Apache-2.0
#include "telemime/capture/shown_url.h"

#include <algorithm>

namespace telemime {

std::string shown_url(const std::string& url) {
  const std::size_t scheme = url.find("://");
  if (scheme == std::string::npos) {
    return url;
  }
  const std::size_t start = scheme + 3;
  const std::string place = url.substr(start, std::min(url.find_first_of("?#", start), url.size()) - start);
  // A password may hold a "/" that should have been written otherwise: then the host begins behind the last
  // @.
  const std::size_t slash = place.find('/');
  const std::size_t at = place.substr(0, slash).find(':') == std::string::npos
                             ? place.substr(0, slash).rfind('@')
                             : place.rfind('@');
  return url.substr(0, start) + (at == std::string::npos ? place : place.substr(at + 1));
}

}  // namespace telemime
