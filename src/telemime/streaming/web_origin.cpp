// SPDX-License-Identifier: Apache-2.0
#include "telemime/streaming/web_origin.h"

#include <algorithm>
#include <boost/asio/ip/address_v6.hpp>
#include <charconv>

#include "telemime/core/errors.h"

namespace telemime {
namespace {

constexpr std::uint16_t http_port = 80;
constexpr std::uint16_t https_port = 443;

bool in_a_name(char c) {
  return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-' || c == '.' || c == '_';
}

std::string lower(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return result;
}

}  // namespace

WebNames::WebNames(std::uint16_t port, const std::vector<std::string>& hosts, bool secure)
    : port_(port), usual_port_(secure ? https_port : http_port) {
  for (const char* own : {"localhost", "127.0.0.1", "::1"}) {
    names_.push_back({own, port});
  }
  for (const std::string& host : hosts) {
    const std::optional<Name> name = parse(host, port);
    if (!name) {
      throw Error(ErrorKind::usage, "'" + host + "' is no name of a host",
                  "Write it as it stands in the browser's address line, for instance studio.local or "
                  "studio.local:8080.");
    }
    names_.push_back(*name);
  }
}

std::optional<WebNames::Name> WebNames::parse(std::string_view text, std::uint16_t default_port) {
  Name result{{}, default_port};
  if (text.starts_with('[')) {
    const std::size_t end = text.find(']');
    if (end == std::string_view::npos) {
      return std::nullopt;
    }
    boost::system::error_code error;
    const auto address = boost::asio::ip::make_address_v6(std::string(text.substr(1, end - 1)), error);
    if (error) {
      return std::nullopt;
    }
    result.name = address.to_string();
    text.remove_prefix(end + 1);
  } else {
    result.name = lower(text.substr(0, text.find(':')));
    text.remove_prefix(result.name.size());
    if (result.name.empty() || !std::all_of(result.name.begin(), result.name.end(), in_a_name)) {
      return std::nullopt;
    }
  }
  if (text.empty()) {
    return result;
  }
  const char* end = text.data() + text.size();
  const auto [last, error] = std::from_chars(text.data() + 1, end, result.port);
  if (text.front() != ':' || text.size() < 2 || error != std::errc() || last != end || result.port == 0) {
    return std::nullopt;
  }
  return result;
}

bool WebNames::allowed(const std::optional<Name>& name, std::string_view local) const {
  if (!name) {
    return false;
  }
  return (name->port == port_ && name->name == local) ||
         std::any_of(names_.begin(), names_.end(),
                     [&](const Name& known) { return known.name == name->name && known.port == name->port; });
}

bool WebNames::host(std::string_view value, std::string_view local) const {
  return allowed(parse(value, usual_port_), local);
}

bool WebNames::origin(std::string_view value, std::string_view local) const {
  constexpr std::string_view plain = "http://";
  constexpr std::string_view secure = "https://";
  if (value.starts_with(plain)) {
    return allowed(parse(value.substr(plain.size()), http_port), local);
  }
  return value.starts_with(secure) && allowed(parse(value.substr(secure.size()), https_port), local);
}

}  // namespace telemime
