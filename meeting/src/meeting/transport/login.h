// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "meeting/protocol/topics.h"
#include "meeting/transport/mqtt_connection.h"

namespace telemime::meeting {

/// What the server of a meeting gives to a participant.
struct Credentials {
  std::string broker;  ///< its plain MQTT listener: "mqtt://host:1883" or "mqtts://host:8883"
  std::string user, password;
  std::string topic;        ///< "r/<tenant>/<meeting>"
  std::string participant;  ///< empty: may only watch
  std::string rejoin;       ///< token for the same seat (the answer's "return")
};

/// A login by the link of a meeting (meeting/docs/protocol.md, "Login").
struct LinkLogin {
  std::string link;          ///< http(s)://host[:port]/room#k=...; without "#k=..." if there is a token
  bool watch = false;        ///< an account that can only read is enough
  std::string rejoin;        ///< Credentials::rejoin of an earlier login; may be empty
  std::filesystem::path ca;  ///< PEM file of the authorities for https; empty: those of the system
  std::vector<std::string> addresses = {};  ///< of the host, if they are known
  std::function<bool()> stopped = {};       ///< returns true to cancel within 0.1 s; may be empty
};

/// Whether the text looks like the link of a meeting: http(s)://...#k=...
bool is_meeting_link(std::string_view text);

/// The link without its secret, safe to show: "http://host:7080/room". Other text is returned unchanged.
std::string without_secret(const std::string& link);

/// Requests an account from the server of a meeting: POST /room/enter. Blocks for at most 10 s, plus the
/// lookup of the host. Throws Error(usage) for an invalid link, and Error(input) when the server refuses (403
/// 404 409 423 429), cannot be reached, is not trusted or answers wrongly. No message contains a secret.
Credentials log_in_by_link(const LinkLogin& login);

/// An account at the broker of a meeting.
struct BrokerLogin {
  MqttServer server;
  MeetingAddress meeting;
  std::string participant;  ///< whose messages it may publish; empty: may only watch
  std::string warning;      ///< shown while there is no failure
};

/// The account of these credentials. `ca` as in LinkLogin. Throws Error(input) when they are invalid.
BrokerLogin login_of(const Credentials& credentials, const std::filesystem::path& ca);

/// A way to log in to a meeting: by its link, or by the URL of its broker,
/// mqtt://[user:password@]host/tenant/meeting (options key=FILE, and ca=FILE for mqtts).
class MeetingLogin {
 public:
  using LogIn = std::function<Credentials(const LinkLogin&)>;

  /// `watch`: an account that can only read is enough. `stopped`: as in LinkLogin. Throws Error(usage) for an
  /// invalid URL.
  MeetingLogin(const std::string& where, bool watch, std::filesystem::path ca, std::function<bool()> stopped,
               LogIn log_in = log_in_by_link);
  /// Logs in, or logs in again to the same seat if possible. Throws like log_in_by_link().
  BrokerLogin log_in();
  bool is_link() const { return !link_.link.empty(); }
  /// The link or URL without secrets.
  const std::string& shown() const { return shown_; }

 private:
  LinkLogin link_;
  LogIn log_in_by_link_;
  BrokerLogin login_;  ///< of a URL
  std::string shown_;
};

}  // namespace telemime::meeting
