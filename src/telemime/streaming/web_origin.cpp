// SPDX-License-Identifier: Apache-2.0
#include "telemime/streaming/web_origin.h"

#include <algorithm>

#include "telemime/core/errors.h"
#include "telemime/streaming/url.h"

namespace telemime {
namespace {

constexpr std::uint16_t http_port = 80;
constexpr std::uint16_t https_port = 443;

}  // namespace

WebNames::WebNames(std::uint16_t port, const std::vector<std::string>& hosts, bool secure)
    : port_(port), usual_port_(secure ? https_port : http_port) {
  for (const char* own : {"localhost", "127.0.0.1", "::1"}) {
    names_.push_back({own, port});
  }
  for (const std::string& host : hosts) {
    const std::optional<Name> name = parse(host, port);
    if (!name) {
      throw Error(ErrorKind::usage, "'" + host + "' is not a host name",
                  "Write it as the browser's address bar shows it, for instance studio.local or "
                  "studio.local:8080.");
    }
    names_.push_back(*name);
  }
}

std::optional<WebNames::Name> WebNames::parse(std::string_view text, std::uint16_t default_port) {
  const std::optional<HostAndPort> parsed = parse_host_and_port(text);
  return parsed ? std::optional(Name{parsed->host, parsed->port.value_or(default_port)}) : std::nullopt;
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
