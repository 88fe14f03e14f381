// SPDX-License-Identifier: Apache-2.0
#include "telemime/streaming/url.h"

#include <algorithm>
#include <cctype>
#include <charconv>

#include "telemime/core/errors.h"

namespace telemime {
namespace {

constexpr std::size_t kLongestUrl = 2000;
constexpr std::size_t kLongestHost = 253;  // RFC 1035, 2.3.4

bool is_letter_or_digit(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0;
}

bool is_host(std::string_view host, bool ipv6) {
  const std::string_view others = ipv6 ? ":.%" : ".-_";
  return host.size() <= kLongestHost && std::all_of(host.begin(), host.end(), [&](char c) {
           return is_letter_or_digit(c) || others.find(c) != std::string_view::npos;
         });
}

/// Takes what stands before the first of `ends` off the front of `rest`.
std::string_view take_until(std::string_view& rest, std::string_view ends) {
  const std::string_view taken = rest.substr(0, rest.find_first_of(ends));
  rest.remove_prefix(taken.size());
  return taken;
}

bool is_port(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

bool begins_with(std::string_view scheme, std::string_view word) {
  const auto same = [](char a, char b) { return std::tolower(static_cast<unsigned char>(a)) == b; };
  return scheme.size() >= word.size() &&
         std::equal(word.begin(), word.end(), scheme.begin(), [&](char b, char a) { return same(a, b); });
}

bool is_room_scheme(std::string_view scheme) {
  return begins_with(scheme, "mqtt");
}

/// Of a room's page: its links have their secret behind "#".
bool is_page_scheme(std::string_view scheme) {
  return begins_with(scheme, "http");
}

constexpr std::string_view kInvite = "#k=";

/// Where the secret of a room's link begins, "#" included.
std::size_t secret_of_link(std::string_view url) {
  return url.find(is_page_scheme(url) ? std::string_view("#") : kInvite);
}

class Parser {
 public:
  Parser(const std::string& text, std::string_view example, UrlUser user)
      : text_(text), shown_(without_password(text)), example_(example), user_(user) {}

  SendUrl parse() const {
    if (text_.size() > kLongestUrl) {
      throw Error(ErrorKind::usage, "the address of an output is longer than 2000 characters");
    }
    if (!std::all_of(text_.begin(), text_.end(), [](char c) { return c > ' ' && c < '\x7f'; })) {
      fail("holds characters that do not belong in an address");
    }
    SendUrl url;
    url.text = shown_;
    std::string_view rest = text_;
    const std::size_t end = rest.find("://");
    if (end == std::string_view::npos || end == 0) {
      fail("has no scheme (the word before \"://\")");
    }
    url.scheme = rest.substr(0, end);
    std::transform(url.scheme.begin(), url.scheme.end(), url.scheme.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    rest.remove_prefix(end + 3);
    if (is_page_scheme(url.scheme)) {
      invite(rest, url);
    }
    if (user_ == UrlUser::taken) {
      user(rest, url);
    }
    url.host = host(rest);
    url.port = port(rest);
    if (is_room_scheme(url.scheme) && rest.find('@') != std::string_view::npos) {
      fail("has an \"@\" behind its host; %40 stands for one");  // or a password was mistaken for a path
    }
    url.path = take_until(rest, "?#");
    url.options = options(rest);
    return url;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(ErrorKind::usage, "the output \"" + shown_ + "\" " + what,
                "Write it like " + std::string(example_) + ".");
  }

  /// Takes the secret of a room's link off.
  void invite(std::string_view& rest, SendUrl& url) const {
    const std::size_t start = rest.find('#');
    if (start == std::string_view::npos) {
      return;
    }
    const std::string_view fragment = rest.substr(start);
    constexpr std::size_t kLongestInvite = 200;
    const auto may_stand = [](char c) {
      return is_letter_or_digit(c) || std::string_view("_.~-").find(c) != std::string_view::npos;
    };
    url.password = fragment.starts_with(kInvite) ? fragment.substr(kInvite.size()) : "";
    if (url.password.empty() || url.password.size() > kLongestInvite ||
        !std::all_of(url.password.begin(), url.password.end(), may_stand)) {
      fail("has behind \"#\" what no room's link has; it may be cut off");
    }
    rest = rest.substr(0, start);
  }

  void user(std::string_view& rest, SendUrl& url) const {
    const std::string_view authority = rest.substr(0, rest.find_first_of("/?#"));
    const std::size_t at = authority.rfind('@');
    if (at == std::string_view::npos) {
      return;
    }
    const std::string_view both = authority.substr(0, at);
    const std::string_view name = both.substr(0, both.find(':'));
    const auto user = percent_decoded(name);
    const auto password = percent_decoded(both.substr(std::min(name.size() + 1, both.size())));
    if (!user || !password || user->empty()) {
      fail("has a user or password that cannot be understood");
    }
    url.user = *user;
    url.password = *password;
    rest.remove_prefix(at + 1);
  }

  std::string host(std::string_view& rest) const {
    const bool ipv6 = rest.starts_with('[');
    if (ipv6) {
      rest.remove_prefix(1);
    }
    const std::string_view host = take_until(rest, ipv6 ? "]" : ":/?#");
    if (!is_host(host, ipv6) || (ipv6 && rest.empty())) {
      fail("has no host that can be understood");
    }
    if (ipv6) {
      rest.remove_prefix(1);
    }
    return std::string(host);
  }

  std::optional<std::uint16_t> port(std::string_view& rest) const {
    if (!rest.starts_with(':')) {
      if (!rest.empty() && rest.front() != '/' && rest.front() != '?') {
        fail("has something behind its host that cannot be understood");
      }
      return std::nullopt;
    }
    rest.remove_prefix(1);
    const std::string_view digits = take_until(rest, "/?#");
    std::uint16_t port = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), port);
    if (digits.empty() || error != std::errc() || end != digits.data() + digits.size()) {
      fail("has a port that is not a number from 0 to 65535");
    }
    return port;
  }

  std::vector<std::pair<std::string, std::string>> options(std::string_view rest) const {
    std::vector<std::pair<std::string, std::string>> found;
    if (rest.empty()) {
      return found;
    }
    if (rest.front() != '?') {
      fail("has a \"#\", which means nothing here");
    }
    do {
      rest.remove_prefix(1);
      std::string_view item = take_until(rest, "&#");
      const std::string_view name = take_until(item, "=");
      if (name.empty() || item.empty()) {
        fail("has an option that is not name=value");
      }
      found.emplace_back(name, item.substr(1));
    } while (rest.starts_with('&'));
    if (!rest.empty()) {
      fail("has a \"#\", which means nothing here");
    }
    return found;
  }

  const std::string& text_;
  std::string shown_;
  std::string_view example_;
  UrlUser user_;
};

std::string listed(std::initializer_list<std::string_view> words) {
  std::string list;
  for (const std::string_view word : words) {
    list += (list.empty() ? "" : ", ") + std::string(word);
  }
  return list;
}

}  // namespace

SendUrl parse_url(const std::string& text, std::string_view example, UrlUser user) {
  return Parser(text, example, user).parse();
}

std::string without_password(const std::string& given) {
  std::string url = given.substr(0, secret_of_link(given));
  const std::size_t scheme = url.find("://");
  if (scheme == std::string::npos) {
    return url;
  }
  const std::size_t start = scheme + 3;
  const std::size_t end = std::min(url.find_first_of("/?#", start), url.size());
  const std::size_t colon = url.find(':', start);
  std::size_t at = url.substr(0, end).rfind('@');
  if (at == std::string::npos || at < start) {
    // No user in the right place. A password with a "/" in it would be one in the wrong place.
    const bool host_and_path = colon == std::string::npos || colon > end ||
                               is_port(std::string_view(url).substr(colon + 1, end - colon - 1));
    at = host_and_path && !is_room_scheme(url) ? std::string::npos : url.rfind('@');
  }
  return at == std::string::npos || colon == std::string::npos || colon > at
             ? url
             : url.substr(0, colon) + url.substr(at);
}

std::optional<std::string> percent_decoded(std::string_view text) {
  std::string decoded;
  while (!text.empty()) {
    const std::string_view plain = take_until(text, "%");
    decoded += plain;
    if (text.empty()) {
      break;
    }
    unsigned byte = 0;
    const std::string_view digits = text.substr(1, 2);
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), byte, 16);
    if (digits.size() != 2 || error != std::errc() || end != digits.data() + 2) {
      return std::nullopt;
    }
    decoded += static_cast<char>(byte);
    text.remove_prefix(3);
  }
  return decoded;
}

void check_options(const SendUrl& url, std::initializer_list<std::string_view> names) {
  for (const auto& [name, value] : url.options) {
    if (std::find(names.begin(), names.end(), name) == names.end()) {
      throw Error(ErrorKind::usage, "the output \"" + url.text + "\" has no option \"" + name + "\"",
                  "Its options are " + listed(names) + ".");
    }
  }
}

std::optional<std::string> free_option(const SendUrl& url, std::string_view name) {
  for (const auto& [given, value] : url.options) {
    if (given == name) {
      return value;
    }
  }
  return std::nullopt;
}

std::string option(const SendUrl& url, std::string_view name,
                   std::initializer_list<std::string_view> values) {
  std::string value = free_option(url, name).value_or(std::string(*values.begin()));
  if (std::find(values.begin(), values.end(), value) == values.end()) {
    throw Error(
        ErrorKind::usage,
        "the option \"" + std::string(name) + "\" of \"" + url.text + "\" cannot be \"" + value + "\"",
        "It is one of " + listed(values) + ".");
  }
  return value;
}

std::string host_and_port(const std::string& host, std::uint16_t port) {
  const bool ipv6 = host.find(':') != std::string::npos;
  return (ipv6 ? "[" + host + "]" : host) + ":" + std::to_string(port);
}

void require_host(const SendUrl& url) {
  if (url.host.empty()) {
    throw Error(ErrorKind::usage, "the output \"" + url.text + "\" does not say to which computer",
                "Put its name or address behind \"://\", localhost for this one.");
  }
}

}  // namespace telemime
