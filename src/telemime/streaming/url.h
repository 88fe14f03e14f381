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

/// scheme://user:password@host:port/path?name=value&name=value, in its parts. An output over the network is
/// named so.
struct SendUrl {
  std::string text;      ///< as the user gave it, without the password: fit to be shown
  std::string scheme;    ///< in small letters
  std::string user;      ///< may be empty
  std::string password;  ///< or the secret of a room's link (http, https); may be empty; shown to nobody
  std::string host;      ///< a name or an address, without the brackets of IPv6; may be empty
  std::optional<std::uint16_t> port;
  std::string path;  ///< with its "/"; may be empty
  std::vector<std::pair<std::string, std::string>> options;
};

/// Whether "user:password@" may stand before the host.
enum class UrlUser { refused, taken };

/// Throws Error(usage) that shows a right one (`example`) when the text is no such URL.
SendUrl parse_url(const std::string& text, std::string_view example, UrlUser user = UrlUser::refused);

/// The URL without the password before its host and without the secret of a room's link ("#k=..."): fit to be
/// shown and kept. Also takes what stands in the place of one in a text that is no URL.
std::string without_password(const std::string& given);

/// "%41" becomes "A". Nothing when a "%" has no two hexadecimal digits behind it.
std::optional<std::string> percent_decoded(std::string_view text);

/// Throws Error(usage) when there is an option that is not among `names`.
void check_options(const SendUrl& url, std::initializer_list<std::string_view> names);

/// The value of the option, the first of `values` when the URL does not have it. Throws Error(usage) that
/// lists them when its value is not one of them.
std::string option(const SendUrl& url, std::string_view name, std::initializer_list<std::string_view> values);

/// The value of the option as it stands; nothing when the URL does not have it.
std::optional<std::string> free_option(const SendUrl& url, std::string_view name);

/// "host:port" as it stands in a URL: an IPv6 address gets its brackets.
std::string host_and_port(const std::string& host, std::uint16_t port);

/// Throws Error(usage) when the URL names no host.
void require_host(const SendUrl& url);

}  // namespace telemime
