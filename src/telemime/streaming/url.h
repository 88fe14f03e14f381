// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace telemime {

/// The address of an output over the network, scheme://user:password@host:port/path?name=value&name=value.
struct SendUrl {
  std::string text;      ///< as the user gave it, without its secret: safe to show and to store
  std::string scheme;    ///< in lower case
  std::string user;      ///< may be empty
  std::string password;  ///< the secret: the password, or the access key of an http(s) link ("#k=..."); may
                         ///< be empty; must never be shown
  std::string host;      ///< a name or an address, IPv6 without brackets; never empty
  std::optional<std::uint16_t> port;  ///< 1 to 65535
  std::string path = "/";
  std::vector<std::pair<std::string, std::string>> options;
};

/// Whether "user:password@" may precede the host.
enum class UrlCredentials { rejected, accepted };

/// Throws Error(usage), with `example` as a valid URL, when the text is not a URL of this form.
SendUrl parse_url(const std::string& text, std::string_view example,
                  UrlCredentials credentials = UrlCredentials::rejected);

/// The URL without the password before its host and without the access key of a link ("#k=..."): safe to show
/// and to store. Also works for text that is not a valid URL.
std::string without_password(const std::string& given);

/// Throws Error(usage) when the URL has an option that is not among `names`.
void check_options(const SendUrl& url, std::initializer_list<std::string_view> names);

/// The value of the option, or the first of `values` when the URL does not have it. Throws Error(usage), with
/// the list of values, when it is none of them.
std::string option(const SendUrl& url, std::string_view name, std::initializer_list<std::string_view> values);

/// The value of the option as written; nothing when the URL does not have it.
std::optional<std::string> find_option(const SendUrl& url, std::string_view name);

/// A host and an optional port, as in the Host header of HTTP.
struct HostAndPort {
  std::string host;  ///< in lower case, IPv6 in its shortest form without brackets
  std::optional<std::uint16_t> port;
};

/// Parses "host", "host:port", "[IPv6]" or "[IPv6]:port". Returns nothing for anything else.
std::optional<HostAndPort> parse_host_and_port(std::string_view text);

/// "host:port" as in a URL: an IPv6 address gets its brackets.
std::string host_and_port(const std::string& host, std::uint16_t port);

}  // namespace telemime
