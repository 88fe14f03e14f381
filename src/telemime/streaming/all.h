// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "telemime/streaming/sender.h"
#include "telemime/streaming/url.h"

namespace telemime {

/// Default port of the "Marionette", the receiver of the VMC protocol.
inline constexpr std::uint16_t kMarionettePort = 39539;

/// vmc://host[:39539][?bundle=1|0][&positions=all|hips][&root=still|moves][&expressions=vrm0|vrm1|arkit]: the
/// VMC protocol over UDP (vmc_messages.h). UDP has no connections: a missing receiver is noticed only if the
/// system reports it, which it always does on this computer. Throws Error(usage).
std::unique_ptr<Sender> make_vmc_sender(const SendUrl& url);

/// Port at which VRChat listens for OSC.
inline constexpr std::uint16_t kVrchatPort = 9000;

/// vrchat://host[:9000][?trackers=chest,elbows,hands][&bundle=1|0]: OSC trackers over UDP, a position (m) and
/// Euler angles (degrees; about z, then x, then y) for the head, hips (1), chest (2), elbows (3 left, 4
/// right, turned as the upper arms) and hands (5, 6) in the left-handed frame of Unity: y up, the person
/// faces +z at first. Rotations are those from the T-pose. Nothing is sent while the person is lost. Throws
/// Error(usage).
std::unique_ptr<Sender> make_vrchat_sender(const SendUrl& url);

/// bap+tcp://host:port[?profile=iso|greta|vreng-3.1|vreng-3.2]: connects by TCP and writes an endless
/// motion.bap (outputs/all.h): the header with 0 frames once per connection, then two lines per frame. Frames
/// in which the person is lost repeat the last pose, as in the file. Throws Error(usage).
std::unique_ptr<Sender> make_bap_tcp_sender(const SendUrl& url);

inline constexpr std::uint16_t kHttpPort = 80;

/// ws://host[:80][/path][?...]: connects as a WebSocket client and sends the messages `body` and `pose` of
/// docs/live-protocol.md as text. `mirror` is an option of Telemime; all other options are passed to the
/// receiver with the path. Throws Error(usage).
std::unique_ptr<Sender> make_web_socket_sender(const SendUrl& url);

/// All kinds of outputs of this module. A new kind needs a Link (send_queue.h) and a line here. Each has the
/// option `mirror`.
inline constexpr std::array<SenderKind, 4> kSenderKinds = {{
    {"vmc", kMarionettePort, "vmc://localhost:39539",
     "bundle=1|0, positions=all|hips, root=still|moves, expressions=vrm0|vrm1|arkit, mirror=0|1",
     "avatar programs that receive the VMC protocol: VSeeFace, Warudo, VNyan, EVMC4U", make_vmc_sender},
    {"vrchat", kVrchatPort, "vrchat://localhost:9000", "trackers=chest,elbows,hands, bundle=1|0, mirror=0|1",
     "VRChat: head, chest, elbows and hands as OSC trackers", make_vrchat_sender},
    {"bap+tcp", 0, "bap+tcp://localhost:5000", "profile=iso|greta|vreng-3.1|vreng-3.2, mirror=0|1",
     "MPEG-4 body animation parameters as lines of text, for a program that listens", make_bap_tcp_sender},
    {"ws", kHttpPort, "ws://localhost:8080/motion", "mirror=0|1; other options are passed to the receiver",
     "JSON messages over a WebSocket, for your own programs", make_web_socket_sender},
}};

}  // namespace telemime
