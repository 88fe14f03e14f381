// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace telemime {

/// The names under which a server may be called. A page of another web site can make the browser ask this
/// server: Host shows its own name for this address (DNS rebinding), Origin shows where requests come from.
class WebNames {
 public:
  /// localhost, 127.0.0.1 and [::1] at `port`, and `hosts`: names at `port`, or "name:port". Throws
  /// Error(usage) for a host that is none. `secure`: asked for by https.
  WebNames(std::uint16_t port, const std::vector<std::string>& hosts, bool secure = false);

  /// The value of a Host header. `local` is the address at which the connection came in, as text: its user
  /// may have called it by that (a number cannot be rebound).
  bool host(std::string_view value, std::string_view local) const;
  /// The value of an Origin header; "null" and anything but http(s) are refused.
  bool origin(std::string_view value, std::string_view local) const;

 private:
  struct Name {
    std::string name;  ///< lower case, IPv6 without brackets in its shortest form
    std::uint16_t port;
  };
  static std::optional<Name> parse(std::string_view text, std::uint16_t default_port);
  bool allowed(const std::optional<Name>& name, std::string_view local) const;

  std::uint16_t port_;
  std::uint16_t usual_port_;  ///< that a Host header leaves out
  std::vector<Name> names_;
};

}  // namespace telemime
