// SPDX-License-Identifier: Apache-2.0
#include "meeting/transport/login.h"

#include <utility>

#include "meeting/transport/mqtt_sender.h"
#include "telemime/core/errors.h"
#include "telemime/streaming/url.h"

namespace telemime::meeting {
namespace {

constexpr const char* kExample = "mqtt://localhost:1883/home/studio";

[[noreturn]] void no_key() {
  throw Error(ErrorKind::input, "the room's server gave an account that cannot be used",
              "Is it of another version than this program?");
}

MeetingAddress meeting_of_topic(const std::string& topic) {
  const std::string start = "r/";
  const std::size_t slash = topic.find('/', start.size());
  if (!topic.starts_with(start) || slash == std::string::npos) {
    no_key();
  }
  MeetingAddress meeting{topic.substr(start.size(), slash - start.size()), topic.substr(slash + 1)};
  if (!is_topic_segment(meeting.tenant) || !is_topic_segment(meeting.meeting)) {
    no_key();
  }
  return meeting;
}

}  // namespace

BrokerLogin login_of(const Credentials& key, const std::filesystem::path& ca) {
  BrokerLogin login;
  const SendUrl url = parse_url(key.broker, kExample);
  const bool tls = url.scheme == "mqtts";
  if ((!tls && url.scheme != "mqtt") || url.host.empty() ||
      (!key.participant.empty() && !is_topic_segment(key.participant))) {
    no_key();
  }
  login.server.host = url.host;
  login.server.port = url.port.value_or(tls ? kMqttsPort : kMqttPort);
  login.server.ca_file = tls ? std::optional(ca.string()) : std::nullopt;
  login.server.user = key.user;
  login.server.password = key.password;
  login.meeting = meeting_of_topic(key.topic);
  login.participant = key.participant;
  return login;
}

MeetingLogin::MeetingLogin(const std::string& where, bool watch, std::filesystem::path ca, Enter enter)
    : enter_(std::move(enter)) {
  if (is_meeting_link(where)) {
    entry_.link = where;
    entry_.watch = watch;
    entry_.ca = std::move(ca);
    shown_ = without_secret(where);
    return;
  }
  const SendUrl url = parse_url(where, kExample, UrlUser::taken);
  if (url.scheme != "mqtt" && url.scheme != "mqtts") {
    throw Error(ErrorKind::usage, "\"" + url.text + "\" is neither a room's link nor a broker's URL",
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
  const Credentials key = enter_(entry_);
  entry_.rejoin = key.rejoin;
  return login_of(key, entry_.ca);
}

}  // namespace telemime::meeting
