// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "meeting/protocol/topics.h"
#include "meeting/transport/link_login.h"
#include "meeting/transport/mqtt_connection.h"

namespace telemime::meeting {

/// An account at a room's broker.
struct BrokerLogin {
  MqttServer server;
  MeetingAddress meeting;
  std::string participant;  ///< whose messages it may write; empty: may only watch
  std::string warning;      ///< for the user, while all is well otherwise
};

/// The login that a room's server gave. `ca` as in LinkLogin. Throws Error(input) when it is none.
BrokerLogin login_of(const Credentials& key, const std::filesystem::path& ca);

/// How a program comes into a room: by its link, or by the broker's URL,
/// mqtt://[user:password@]host/tenant/room (options key=FILE, and ca=FILE with mqtts://).
class MeetingLogin {
 public:
  using Enter = std::function<Credentials(const LinkLogin&)>;

  /// `watch`: an account that only reads is enough. `enter`: log_in_by_link(). Throws Error(usage) for a URL
  /// that is none.
  MeetingLogin(const std::string& where, bool watch, std::filesystem::path ca, Enter enter = log_in_by_link);
  /// Comes in, or in again: then by the same seat, if the link's server has it. Throws as log_in_by_link()
  /// does.
  BrokerLogin log_in();
  bool is_link() const { return !entry_.link.empty(); }
  /// Where it leads, without secrets.
  const std::string& shown() const { return shown_; }

 private:
  LinkLogin entry_;
  Enter enter_;
  BrokerLogin login_;  ///< of a URL
  std::string shown_;
};

}  // namespace telemime::meeting
