// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

#include "telemime/network/bap_serve.h"
#include "telemime/network/bap_tcp.h"
#include "telemime/network/mqtt_sender.h"
#include "telemime/network/room_sender.h"
#include "telemime/network/sender.h"
#include "telemime/network/url.h"
#include "telemime/network/vmc.h"
#include "telemime/network/web_socket_sender.h"

namespace telemime {

/// One way to send frames to other programs.
struct SenderKind {
  std::string_view scheme;   ///< before "://"
  std::uint16_t port = 0;    ///< when the URL names none; 0: it must
  std::string_view example;  ///< a URL that can be typed as it is
  std::string_view options;  ///< behind "?", for the user; the first value of each is the default
  std::string_view summary;
  /// Throws Error(usage) when the URL cannot be used.
  std::unique_ptr<Sender> (*make)(const SendUrl&);
  UrlUser user = UrlUser::refused;
};

/// All of them. A new kind is a Link (send_queue.h) and a line here. `mirror` is an option of each.
inline constexpr std::array<SenderKind, 8> kSenderKinds = {{
    {"vmc", kMarionettePort, "vmc://localhost:39539",
     "bundle=1|0, positions=all|hips, root=still|moves, mirror=0|1",
     "avatar programs that take the VMC protocol: VSeeFace, Warudo, VNyan, EVMC4U", make_vmc_sender},
    {"bap+tcp", 0, "bap+tcp://localhost:5000", "profile=iso|greta|vreng-3.1|vreng-3.2, mirror=0|1",
     "MPEG-4 body animation parameters as lines of text, to a program that listens", make_bap_tcp_sender},
    {"bap+serve", kVapsPort, "bap+serve://:4150", "profile=vreng-3.1|vreng-3.2|iso|greta, mirror=0|1",
     "a server of MPEG-4 body animation parameters that VREng's clients can play", make_bap_serve_sender},
    {"ws", kHttpPort, "ws://localhost:8080/motion", "mirror=0|1; all others go to the receiver",
     "JSON messages over a WebSocket, for programs of one's own", make_web_socket_sender},
    {"mqtt", kMqttPort, "mqtt://localhost:1883/home/studio",
     "mirror=0|1, look=plain; name, seat, participant, key",
     "a room that several people share, at an MQTT broker", make_mqtt_sender, UrlUser::taken},
    {"mqtts", kMqttsPort, "mqtts://localhost:8883/home/studio",
     "mirror=0|1, look=plain; ca, name, seat, participant, key", "the same, encrypted by TLS",
     make_mqtt_sender, UrlUser::taken},
    {"http", kHttpPort, "http://localhost:7080/room#k=INVITE", "mirror=0|1, look=plain; name, seat",
     "a room by its link, as telemime room prints it", make_room_sender},
    {"https", kHttpsPort, "https://localhost:7080/room#k=INVITE", "mirror=0|1, look=plain; ca, name, seat",
     "the same, encrypted by TLS", make_room_sender},
}};

inline std::span<const SenderKind> sender_kinds() {
  return kSenderKinds;
}

}  // namespace telemime
