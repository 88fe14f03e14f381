// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace telemime::meeting {

/// What a participant needs to take part in a room.
struct Credentials {
  std::string broker;  ///< of the plain MQTT listener: "mqtt://host:1883" or "mqtts://host:8883"
  std::string user, password;
  std::string topic;               ///< "r/<tenant>/<room>"
  std::string participant;         ///< empty: may only watch
  std::vector<std::string> roles;  ///< "speak", "board", "chair", "watch"
  std::string rejoin;              ///< the answer's "return": gives the same seat again
};

/// How to come in (docs/room-page.md, "Coming in").
struct LinkLogin {
  std::string link;          ///< http(s)://host[:port]/room#k=...; without "#k=..." where there is a way back
  bool watch = false;        ///< an account that only reads
  std::string rejoin;        ///< Credentials::rejoin of an earlier entry; may be empty
  std::filesystem::path ca;  ///< PEM file of the authorities that https trusts; empty: this computer's
  std::vector<std::string> addresses =
      {};                              ///< of the link's host, where they are known; else it is looked up
  std::function<bool()> stopped = {};  ///< asked now and then: true gives up within 0.1 s; may be empty
};

/// Whether the text is a room's link: http(s)://host[:port]/room#k=... Whether it can be used shows later.
bool is_meeting_link(std::string_view text);

/// The link without its secret, to be shown, logged or kept: "http://host:7080/room". Text that is no link
/// comes back as it is.
std::string without_secret(const std::string& link);

/// Asks the room's server for an account: POST /room/enter. Blocks for at most 10 s, and for a look-up of the
/// host's name. Throws Error(usage) for
/// a link that cannot be understood, Error(input) with words for what the server says (403 404 409 423 429),
/// for a server that cannot be reached or that is not trusted, and for an answer that is none. No words hold
/// a secret.
Credentials log_in_by_link(const LinkLogin& entry);

}  // namespace telemime::meeting
