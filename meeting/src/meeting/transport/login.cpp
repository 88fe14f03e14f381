// SPDX-License-Identifier: Apache-2.0
#include "meeting/transport/login.h"

#include <utility>

#include "meeting/transport/senders.h"
#include "telemime/core/errors.h"

namespace telemime::meeting {
namespace {

constexpr const char* kExample = "mqtt://localhost:1883/home/studio";

[[noreturn]] void reject_credentials() {
  throw Error(ErrorKind::input, "the meeting's server gave an account that cannot be used",
              "It may be of another version than this program.");
}

MeetingAddress meeting_of(const std::string& topic) {
  const std::string start = "r/";
  const std::size_t slash = topic.find('/', start.size());
  if (!topic.starts_with(start) || slash == std::string::npos) {
    reject_credentials();
  }
  MeetingAddress meeting{topic.substr(start.size(), slash - start.size()), topic.substr(slash + 1)};
  if (!is_topic_segment(meeting.tenant) || !is_topic_segment(meeting.meeting)) {
    reject_credentials();
  }
  return meeting;
}

}  // namespace

BrokerLogin login_of(const Credentials& credentials, const std::filesystem::path& ca) {
  const SendUrl url = parse_url(credentials.broker, kExample);
  const bool tls = url.scheme == "mqtts";
  if ((!tls && url.scheme != "mqtt") || url.host.empty() ||
      (!credentials.participant.empty() && !is_topic_segment(credentials.participant))) {
    reject_credentials();
  }
  BrokerLogin login;
  login.server.host = url.host;
  login.server.port = url.port.value_or(tls ? kMqttsPort : kMqttPort);
  login.server.ca_file = tls ? std::optional(ca.string()) : std::nullopt;
  login.server.user = credentials.user;
  login.server.password = credentials.password;
  login.meeting = meeting_of(credentials.topic);
  login.participant = credentials.participant;
  return login;
}

MeetingLogin::MeetingLogin(const std::string& where, bool watch, std::filesystem::path ca,
                           std::function<bool()> stopped, LogIn log_in)
    : log_in_by_link_(std::move(log_in)) {
  if (is_meeting_link(where)) {
    link_.link = where;
    link_.watch = watch;
    link_.ca = std::move(ca);
    link_.stopped = std::move(stopped);
    shown_ = without_secret(where);
    return;
  }
  const SendUrl url = parse_url(where, kExample, UrlCredentials::accepted);
  if (url.scheme != "mqtt" && url.scheme != "mqtts") {
    throw Error(ErrorKind::usage,
                "\"" + url.text + "\" is neither the link of a meeting nor the URL of a broker",
                "They look like http://host:7080/room#k=... and " + std::string(kExample) + ".");
  }
  check_options(url, {"key", "ca"});
  const MeetingOutput output = meeting_output_of(url);
  login_ = {output.server, output.meeting, output.participant, output.warning};
  if (login_.server.ca_file && login_.server.ca_file->empty()) {
    login_.server.ca_file = ca.string();
  }
  shown_ = url.text;
}

BrokerLogin MeetingLogin::log_in() {
  if (!is_link()) {
    return login_;
  }
  const Credentials credentials = log_in_by_link_(link_);
  link_.rejoin = credentials.rejoin;
  return login_of(credentials, link_.ca);
}

}  // namespace telemime::meeting
