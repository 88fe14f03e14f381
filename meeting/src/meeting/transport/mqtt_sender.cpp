// SPDX-License-Identifier: Apache-2.0
#include "meeting/transport/mqtt_sender.h"

#include <cstdlib>

#include "meeting/transport/meeting_link.h"
#include "meeting/transport/mqtt_key.h"
#include "telemime/core/errors.h"
#include "telemime/streaming/send_queue.h"

namespace telemime::meeting {
namespace {

constexpr std::string_view kNobody = "tracker";  // who takes part without an account

/// The option's value with its "%41" as "A".
std::optional<std::string> plain_option(const SendUrl& url, std::string_view name) {
  const auto raw = free_option(url, name);
  if (!raw) {
    return std::nullopt;
  }
  auto value = percent_decoded(*raw);
  if (!value) {
    throw Error(ErrorKind::usage, "the option \"" + std::string(name) + "\" of \"" + url.text +
                                      "\" has a \"%\" without two hexadecimal digits");
  }
  return value;
}

[[noreturn]] void refuse(const SendUrl& url, const std::string& what, const std::string& remedy) {
  throw Error(ErrorKind::usage, "the output \"" + url.text + "\" " + what, remedy);
}

MeetingAddress meeting_of(const SendUrl& url) {
  const std::string_view path = std::string_view(url.path).substr(url.path.empty() ? 0 : 1);
  const std::size_t slash = path.find('/');
  MeetingAddress meeting{std::string(path.substr(0, slash)),
                         slash == std::string_view::npos ? "" : std::string(path.substr(slash + 1))};
  if (!is_topic_segment(meeting.tenant) || !is_topic_segment(meeting.meeting)) {
    refuse(url, "does not name a room",
           "Write it like mqtt://localhost:1883/home/studio: small letters, digits, _ and - are a name.");
  }
  return meeting;
}

std::optional<int> seat_of(const SendUrl& url) {
  const auto text = plain_option(url, "seat");
  if (!text) {
    return std::nullopt;
  }
  for (int seat = 0; seat < kMostSeats; ++seat) {
    if (*text == std::to_string(seat)) {
      return seat;
    }
  }
  refuse(url, "names a seat that there is not", "Seats are 0 to " + std::to_string(kMostSeats - 1) + ".");
}

}  // namespace

MeetingOutput meeting_output_of(const SendUrl& url) {
  for (const auto& [name, value] : url.options) {
    if (name == "password" || name == "user") {  // before anything shows the URL
      throw Error(ErrorKind::usage, "an output's user and password are no options",
                  "Write user:password@ before the host, or use key=FILE.");
    }
  }
  check_options(url, {"name", "look", "seat", "participant", "key", "ca", "mirror"});
  require_host(url);
  const bool tls = url.scheme == "mqtts";
  MeetingOutput output;
  output.meeting = meeting_of(url);
  output.server.host = url.host;
  output.server.port = url.port.value_or(tls ? kMqttsPort : kMqttPort);
  if (output.server.port == 0) {
    refuse(url, "has no port", "1883 is the usual one, 8883 with TLS.");
  }
  if (tls) {
    output.server.ca_file = plain_option(url, "ca").value_or("");
  } else if (free_option(url, "ca")) {
    refuse(url, "names certificates, and is not encrypted", "Write mqtts:// for TLS.");
  }
  const auto key = key_of(url, std::getenv(kMeetingKeyVariable));
  if (key) {
    output.server.user = key->user;
    output.server.password = key->password;
    output.warning = key->warning;
  }
  output.participant =
      plain_option(url, "participant")
          .value_or(participant_of_user(output.meeting, output.server.user).value_or(std::string(kNobody)));
  if (!is_topic_segment(output.participant)) {
    refuse(url, "names a participant that cannot be one",
           "1 to 32 small letters, digits, _ and - are a name.");
  }
  output.name = plain_option(url, "name").value_or(output.participant);
  if (!is_participant_name(output.name)) {
    refuse(url, "has a name that cannot be shown", "A name is 1 to 40 characters, in UTF-8.");
  }
  output.look = plain_option(url, "look").value_or(output.look);
  if (!is_topic_segment(output.look)) {
    refuse(url, "has a look that cannot be one", "Looks are plain, robot and the like.");
  }
  output.seat = seat_of(url);
  return output;
}

std::unique_ptr<Sender> make_mqtt_sender(const SendUrl& url) {
  const MeetingOutput output = meeting_output_of(url);
  return make_queued_sender(url, [&](SendLoop& loop) { return std::make_unique<MeetingLink>(loop, output); });
}

}  // namespace telemime::meeting
