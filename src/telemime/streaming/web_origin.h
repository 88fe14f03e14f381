// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace telemime {

/// The host names under which a server responds. A page of another web site can make the browser send
/// requests to this server: Host then shows that site's name for this address (DNS rebinding), Origin shows
/// where the request comes from.
class WebNames {
 public:
  /// localhost, 127.0.0.1 and [::1] at `port`, and `hosts`: names at `port`, or "name:port". Throws
  /// Error(usage) for an invalid host. `secure`: the page is served by https.
  WebNames(std::uint16_t port, const std::vector<std::string>& hosts, bool secure = false);

  /// Whether the value of a Host header is accepted. `local`, the address at which the connection was
  /// accepted, is accepted, too: an address cannot be rebound.
  bool host(std::string_view value, std::string_view local) const;
  /// Whether the value of an Origin header is accepted; "null" and anything but http(s) are refused.
  bool origin(std::string_view value, std::string_view local) const;

 private:
  struct Name {
    std::string name;  ///< lower case, IPv6 without brackets in its shortest form
    std::uint16_t port;
  };
  static std::optional<Name> parse(std::string_view text, std::uint16_t default_port);
  bool allowed(const std::optional<Name>& name, std::string_view local) const;

  std::uint16_t port_;
  std::uint16_t usual_port_;  ///< the port that a Host header omits
  std::vector<Name> names_;
};

}  // namespace telemime
