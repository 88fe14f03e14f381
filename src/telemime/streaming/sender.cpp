// SPDX-License-Identifier: Apache-2.0
#include "telemime/streaming/sender.h"

#include <algorithm>
#include <boost/asio/ip/address.hpp>
#include <map>

#include "telemime/core/errors.h"
#include "telemime/core/text.h"
#include "telemime/streaming/all.h"

namespace telemime {
namespace {

struct KnownUrl {
  const SenderKind& kind;
  SendUrl url;
};

KnownUrl known(const std::string& text, SenderKinds kinds) {
  const SendUrl parts = parse_url(text, kinds.front().example, UrlCredentials::accepted);
  for (const SenderKind& kind : kinds) {
    if (kind.scheme == parts.scheme) {
      return {kind, parse_url(text, kind.example, kind.credentials)};
    }
  }
  throw Error(ErrorKind::usage, "there is no output \"" + parts.scheme + "\" over the network",
              "Use one of " + joined(kinds, &SenderKind::example) + ".");
}

std::string plain_host(std::string host) {
  host = lower_case(host);
  if (host == "localhost") {
    return "127.0.0.1";
  }
  boost::system::error_code no_address;
  const auto address = boost::asio::ip::make_address(host, no_address);
  return no_address ? host : address.to_string();
}

/// Name and first value of each option in SenderKind::options, "bundle=1|0, mirror=0|1; ...".
std::map<std::string, std::string> defaults_of(std::string_view options) {
  std::map<std::string, std::string> defaults;
  options = options.substr(0, options.find(';'));
  while (!options.empty()) {
    const std::string_view item = options.substr(0, options.find(", "));
    options.remove_prefix(std::min(options.size(), item.size() + 2));
    const std::size_t equals = item.find('=');
    const std::string_view values = item.substr(equals + 1);
    defaults.emplace(item.substr(0, equals), values.substr(0, values.find('|')));
  }
  return defaults;
}

}  // namespace

SenderKinds sender_kinds() {
  return kSenderKinds;
}

std::unique_ptr<Sender> make_sender(const std::string& url, SenderKinds kinds) {
  const KnownUrl output = known(url, kinds);
  return output.kind.make(output.url);
}

std::string meaning_of(const std::string& text, SenderKinds kinds) {
  const auto& [kind, url] = known(text, kinds);
  std::string meaning = url.scheme + "://" + (url.user.empty() ? "" : url.user + "@") +
                        host_and_port(plain_host(url.host), url.port.value_or(kind.port)) + url.path;
  std::map<std::string, std::string> ours = defaults_of(kind.options);
  std::string others;  // options of the receiver, for which their order may matter
  for (auto option = url.options.rbegin(); option != url.options.rend(); ++option) {
    // Backward: if an option is given twice, the first one counts.
    if (const auto found = ours.find(option->first); found != ours.end()) {
      found->second = option->second;
    } else {
      others.insert(0, '&' + option->first + '=' + option->second);
    }
  }
  for (const auto& [name, value] : ours) {
    meaning.append("&").append(name).append("=").append(value);
  }
  return meaning + others;
}

}  // namespace telemime
