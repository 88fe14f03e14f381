// SPDX-License-Identifier: Apache-2.0
#include "telemime/streaming/url.h"

#include <curl/curl.h>

#include <algorithm>
#include <memory>
#include <new>

#include "telemime/core/errors.h"
#include "telemime/core/text.h"

namespace telemime {
namespace {

constexpr std::size_t kLongestUrl = 2000;
constexpr std::size_t kLongestKey = 200;
constexpr std::string_view kKeyMark = "#k=";
constexpr std::string_view kLetters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789";

/// Links to web pages carry their access key in the fragment, which browsers never send to the server.
bool has_key_in_fragment(std::string_view url) {
  return lower_case(url.substr(0, 4)) == "http";
}

/// Addresses of brokers often carry "user:password@".
bool has_credentials_often(std::string_view url) {
  return lower_case(url.substr(0, 4)) == "mqtt";
}

/// A URL as libcurl parses it.
class CurlUrl {
 public:
  CurlUrl() {
    if (!url_) {
      throw std::bad_alloc();
    }
  }
  CURLUcode parse(const std::string& text, unsigned flags) {
    return curl_url_set(url_.get(), CURLUPART_URL, text.c_str(), flags);
  }
  /// Empty when the URL does not have the part.
  std::string part(CURLUPart part) const {
    char* text = nullptr;
    if (curl_url_get(url_.get(), part, &text, 0) != CURLUE_OK) {
      return {};
    }
    const std::unique_ptr<char, decltype(&curl_free)> owner(text, curl_free);
    return text;
  }
  std::string host() const {
    std::string host = part(CURLUPART_HOST);
    if (!host.starts_with('[')) {
      return host;
    }
    const std::string zone = part(CURLUPART_ZONEID);
    return host.substr(1, host.size() - 2) + (zone.empty() ? "" : "%" + zone);
  }
  std::optional<std::uint16_t> port() const {
    const std::string port = part(CURLUPART_PORT);
    return port.empty() ? std::nullopt : std::optional(static_cast<std::uint16_t>(std::stoi(port)));
  }

 private:
  std::unique_ptr<CURLU, decltype(&curl_url_cleanup)> url_{curl_url(), curl_url_cleanup};
};

class Parser {
 public:
  Parser(const std::string& text, std::string_view example)
      : text_(text), shown_(without_password(text)), example_(example) {}

  SendUrl parse(UrlCredentials credentials) const {
    // What libcurl would accept or change.
    if (text_.size() > kLongestUrl) {
      throw Error(ErrorKind::usage, "the address of an output is longer than 2000 characters");
    }
    if (!std::all_of(text_.begin(), text_.end(), [](char c) { return c > ' ' && c < '\x7f'; })) {
      fail("contains characters that are not allowed in an address");
    }
    const std::size_t scheme_end = text_.find("://");
    if (scheme_end == std::string::npos || scheme_end == 0) {
      fail("has no scheme (the word before \"://\")");
    }
    if (text_.substr(scheme_end + 3, 1) == "/") {
      fail_without_host();
    }

    CurlUrl parts;
    const bool accepted = credentials == UrlCredentials::accepted;
    check(parts.parse(text_, CURLU_NON_SUPPORT_SCHEME | CURLU_PATH_AS_IS |
                                 (accepted ? 0U : static_cast<unsigned>(CURLU_DISALLOW_USER))));
    SendUrl url;
    url.text = shown_;
    url.scheme = parts.part(CURLUPART_SCHEME);
    set_credentials(parts, url);
    url.host = parts.host();
    url.port = parts.port();
    if (url.port == 0) {
      fail("has a port that is not a number from 1 to 65535");
    }
    url.path = parts.part(CURLUPART_PATH);
    const std::string query = parts.part(CURLUPART_QUERY);
    if (has_credentials_often(url.scheme) && (url.path + query).find('@') != std::string::npos) {
      fail("has an \"@\" after its host; write %40");  // or part of a password was taken for the path
    }
    set_options(query, url);
    return url;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(ErrorKind::usage, "the output \"" + shown_ + "\" " + what,
                "Write it like " + std::string(example_) + ".");
  }

  [[noreturn]] void fail_without_host() const {
    throw Error(
        ErrorKind::usage, "the output \"" + shown_ + "\" does not name the computer to send to",
        "Put its name or address after \"://\", localhost for this one, like " + std::string(example_) + ".");
  }

  void check(CURLUcode result) const {
    switch (result) {
      case CURLUE_OK:
        return;
      case CURLUE_NO_HOST:
        fail_without_host();
      case CURLUE_BAD_PORT_NUMBER:
        fail("has a port that is not a number from 1 to 65535");
      case CURLUE_USER_NOT_ALLOWED:
        fail("cannot have a user name before its host");
      case CURLUE_BAD_LOGIN:
      case CURLUE_BAD_USER:
      case CURLUE_BAD_PASSWORD:
        fail("has an invalid user name or password");
      default:
        fail("has an invalid host");
    }
  }

  void set_credentials(const CurlUrl& parts, SendUrl& url) const {
    const auto user = percent_decoded(parts.part(CURLUPART_USER));
    const auto password = percent_decoded(parts.part(CURLUPART_PASSWORD));
    if (!user || !password || (user->empty() && !password->empty())) {
      fail("has an invalid user name or password");
    }
    url.user = *user;
    url.password = *password;
    const std::size_t mark = text_.find('#');
    if (mark == std::string::npos) {
      return;
    }
    if (!has_key_in_fragment(url.scheme)) {
      fail("has a \"#\", which is not allowed here");
    }
    const std::string_view fragment = std::string_view(text_).substr(mark);
    url.password = fragment.starts_with(kKeyMark) ? fragment.substr(kKeyMark.size()) : "";
    if (url.password.empty() || url.password.size() > kLongestKey ||
        url.password.find_first_not_of(std::string(kLetters) + "_.~-") != std::string::npos) {
      fail("has an invalid access key after \"#\"; the link may be cut off");
    }
  }

  void set_options(std::string_view query, SendUrl& url) const {
    while (!query.empty()) {
      const std::string_view item = query.substr(0, query.find('&'));
      const std::size_t equals = item.find('=');
      if (equals == std::string_view::npos || equals == 0 || query.ends_with('&')) {
        fail("has an option that is not name=value");
      }
      url.options.emplace_back(item.substr(0, equals), item.substr(equals + 1));
      query.remove_prefix(std::min(item.size() + 1, query.size()));
    }
  }

  const std::string& text_;
  std::string shown_;
  std::string_view example_;
};

}  // namespace

SendUrl parse_url(const std::string& text, std::string_view example, UrlCredentials credentials) {
  return Parser(text, example).parse(credentials);
}

// Not with a parser: secrets must also be removed from malformed text before it is shown in a message.
std::string without_password(const std::string& given) {
  const std::string url =
      given.substr(0, given.find(has_key_in_fragment(given) ? std::string_view("#") : kKeyMark));
  const std::size_t scheme = url.find("://");
  if (scheme == std::string::npos) {
    return url;
  }
  const std::size_t start = scheme + 3;
  const std::size_t end = std::min(url.find_first_of("/?#", start), url.size());
  const std::size_t colon = url.find(':', start);
  std::size_t at = url.substr(0, end).rfind('@');
  if (at == std::string::npos || at < start) {
    // There is no user at its usual place. A password that contains "/" moves the "@".
    const bool has_port = colon != std::string::npos && colon + 1 < end &&
                          url.find_first_not_of("0123456789", colon + 1) >= end;
    const bool is_host_and_path = colon == std::string::npos || colon > end || has_port;
    at = is_host_and_path && !has_credentials_often(url) ? std::string::npos : url.rfind('@');
  }
  return at == std::string::npos || colon == std::string::npos || colon > at
             ? url
             : url.substr(0, colon) + url.substr(at);
}

void check_options(const SendUrl& url, std::initializer_list<std::string_view> names) {
  for (const auto& [name, value] : url.options) {
    if (std::find(names.begin(), names.end(), name) == names.end()) {
      throw Error(ErrorKind::usage, "the output \"" + url.text + "\" has no option \"" + name + "\"",
                  "Its options are " + joined(names) + ".");
    }
  }
}

std::optional<std::string> find_option(const SendUrl& url, std::string_view name) {
  for (const auto& [given, value] : url.options) {
    if (given == name) {
      return value;
    }
  }
  return std::nullopt;
}

std::string option(const SendUrl& url, std::string_view name,
                   std::initializer_list<std::string_view> values) {
  std::string value = find_option(url, name).value_or(std::string(*values.begin()));
  if (std::find(values.begin(), values.end(), value) == values.end()) {
    throw Error(
        ErrorKind::usage,
        "the option \"" + std::string(name) + "\" of \"" + url.text + "\" cannot be \"" + value + "\"",
        "It is one of " + joined(values) + ".");
  }
  return value;
}

std::optional<HostAndPort> parse_host_and_port(std::string_view text) {
  CurlUrl url;
  if (text.find_first_of("/?#@\\%, ") != std::string_view::npos || text.ends_with(':') ||
      url.parse("http://" + std::string(text), 0) != CURLUE_OK) {
    return std::nullopt;
  }
  HostAndPort result{lower_case(url.host()), url.port()};
  // libcurl reads "127.1" as 127.0.0.1, but no browser writes such a header.
  const bool as_written = text.starts_with('[') || lower_case(text.substr(0, text.find(':'))) == result.host;
  if (result.port == 0 || !as_written) {
    return std::nullopt;
  }
  return result;
}

std::string host_and_port(const std::string& host, std::uint16_t port) {
  const bool ipv6 = host.find(':') != std::string::npos;
  return (ipv6 ? "[" + host + "]" : host) + ":" + std::to_string(port);
}

}  // namespace telemime
