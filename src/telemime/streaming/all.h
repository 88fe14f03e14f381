// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "telemime/streaming/bap_tcp.h"
#include "telemime/streaming/sender.h"
#include "telemime/streaming/url.h"
#include "telemime/streaming/vmc.h"
#include "telemime/streaming/web_socket_sender.h"

namespace telemime {

/// All of them. A new kind is a Link (send_queue.h) and a line here. `mirror` is an option of each.
inline constexpr std::array<SenderKind, 3> kSenderKinds = {{
    {"vmc", kMarionettePort, "vmc://localhost:39539",
     "bundle=1|0, positions=all|hips, root=still|moves, mirror=0|1",
     "avatar programs that take the VMC protocol: VSeeFace, Warudo, VNyan, EVMC4U", make_vmc_sender},
    {"bap+tcp", 0, "bap+tcp://localhost:5000", "profile=iso|greta|vreng-3.1|vreng-3.2, mirror=0|1",
     "MPEG-4 body animation parameters as lines of text, to a program that listens", make_bap_tcp_sender},
    {"ws", kHttpPort, "ws://localhost:8080/motion", "mirror=0|1; all others go to the receiver",
     "JSON messages over a WebSocket, for programs of one's own", make_web_socket_sender},
}};

}  // namespace telemime
