// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "meeting/transport/link_sender.h"
#include "meeting/transport/mqtt_sender.h"
#include "telemime/streaming/all.h"

namespace telemime::meeting {

/// The ways into a meeting, as kinds of senders.
inline constexpr std::array<SenderKind, 4> kMeetingSenderKinds = {{
    {"mqtt", kMqttPort, "mqtt://localhost:1883/home/studio",
     "mirror=0|1, look=plain; name, seat, participant, key",
     "a room that several people share, at an MQTT broker", make_mqtt_sender, UrlUser::taken},
    {"mqtts", kMqttsPort, "mqtts://localhost:8883/home/studio",
     "mirror=0|1, look=plain; ca, name, seat, participant, key", "the same, encrypted by TLS",
     make_mqtt_sender, UrlUser::taken},
    {"http", kHttpPort, "http://localhost:7080/room#k=INVITE", "mirror=0|1, look=plain; name, seat",
     "a room by its link, as telemime room prints it", make_link_sender},
    {"https", kHttpsPort, "https://localhost:7080/room#k=INVITE", "mirror=0|1, look=plain; ca, name, seat",
     "the same, encrypted by TLS", make_link_sender},
}};

/// Every kind of sender: those of telemime::streaming and those that lead into a meeting.
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
