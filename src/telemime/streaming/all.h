// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "telemime/streaming/sender.h"
#include "telemime/streaming/url.h"

namespace telemime {

/// Where VMC's "Marionette" listens (the protocol's default).
inline constexpr std::uint16_t kMarionettePort = 39539;

/// vmc://host[:39539][?bundle=1|0][&positions=all|hips][&root=still|moves]: the VMC protocol by UDP
/// (vmc_messages.h). UDP has no connection: that nobody listens is known only where the system reports it, on
/// this computer always. Throws Error(usage).
std::unique_ptr<Sender> make_vmc_sender(const SendUrl& url);

/// bap+tcp://host:port[?profile=iso|greta|vreng-3.1|vreng-3.2]: connects by TCP and writes what a file
/// motion.bap holds (outputs/all.h), without end: the header with 0 frames once for each connection,
/// then two lines a frame. Frames in which the person is lost repeat the last pose, as in the file. Throws
/// Error(usage).
std::unique_ptr<Sender> make_bap_tcp_sender(const SendUrl& url);

inline constexpr std::uint16_t kHttpPort = 80;

/// ws://host[:80][/path][?...]: connects as a WebSocket client and sends the messages `body` and `pose` of
/// docs/live-protocol.md as text. `mirror` is an option of ours; the rest of what stands behind "?" goes to
/// the receiver with the path. Throws Error(usage).
std::unique_ptr<Sender> make_web_socket_sender(const SendUrl& url);

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
