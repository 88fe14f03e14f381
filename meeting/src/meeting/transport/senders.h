// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "meeting/transport/meeting_link.h"
#include "telemime/streaming/all.h"
#include "telemime/streaming/sender.h"
#include "telemime/streaming/url.h"

namespace telemime::meeting {

inline constexpr std::uint16_t kMqttPort = 1883;
inline constexpr std::uint16_t kMqttsPort = 8883;
inline constexpr std::uint16_t kHttpsPort = 443;

/// The environment variable that may contain "user:password".
inline constexpr const char* kKeyVariable = "TELEMIME_MEETING_KEY";

/// An account at a broker. The password is shown to nobody.
struct BrokerKey {
  std::string user;
  std::string password;
  std::string warning;  ///< about the file that it was read from
};

/// Reads {"user": "...", "password": "..."}. Warns when other users can read or write the file. Throws
/// Error(usage) with a message that does not quote the file.
BrokerKey read_key_file(const std::filesystem::path& file);

/// The account for an output: from "user:password@" in the URL, or the file of its option `key`, or
/// `environment` (the value of kKeyVariable; may be null), in this order. Throws Error(usage) when it cannot
/// be used, or belongs to another user than the URL names.
std::optional<BrokerKey> key_of(const SendUrl& url, const char* environment);

/// The output of a URL for make_mqtt_sender(). Throws Error(usage).
MeetingOutput meeting_output_of(const SendUrl& url);

/// mqtt://[user:password@]host[:1883]/tenant/meeting[?name=Ana&look=plain&...], or mqtts:// with TLS: takes
/// part in a meeting (meeting/docs/protocol.md). Ending the sender leaves the meeting, within 0.5 s. Throws
/// Error(usage).
std::unique_ptr<Sender> make_mqtt_sender(const SendUrl& url);

/// http(s)://host[:port]/room[?name=Ana&look=plain&seat=3]#k=SECRET: logs in by the link of a meeting
/// (login.h), then works like make_mqtt_sender(). Logs in again when the connection breaks, to the same seat.
/// Throws Error(usage).
std::unique_ptr<Sender> make_link_sender(const SendUrl& url);

/// The kinds of senders that take part in a meeting.
inline constexpr std::array<SenderKind, 4> kMeetingSenderKinds = {{
    {"mqtt", kMqttPort, "mqtt://localhost:1883/home/studio",
     "mirror=0|1, look=plain; name, seat, participant, key", "a meeting at an MQTT broker", make_mqtt_sender,
     UrlCredentials::accepted},
    {"mqtts", kMqttsPort, "mqtts://localhost:8883/home/studio",
     "mirror=0|1, look=plain; ca, name, seat, participant, key", "the same, encrypted by TLS",
     make_mqtt_sender, UrlCredentials::accepted},
    {"http", kHttpPort, "http://localhost:7080/room#k=SECRET", "mirror=0|1, look=plain; name, seat",
     "a meeting by its link, as printed by telemime meeting", make_link_sender},
    {"https", kHttpsPort, "https://localhost:7080/room#k=SECRET", "mirror=0|1, look=plain; ca, name, seat",
     "the same, encrypted by TLS", make_link_sender},
}};

/// All kinds of senders: those of telemime::streaming and those of meetings.
inline constexpr auto kAllSenderKinds = [] {
  std::array<SenderKind, kSenderKinds.size() + kMeetingSenderKinds.size()> all{};
  std::size_t i = 0;
  for (const SenderKind& kind : kSenderKinds) {
    all[i++] = kind;
  }
  for (const SenderKind& kind : kMeetingSenderKinds) {
    all[i++] = kind;
  }
  return all;
}();

}  // namespace telemime::meeting
