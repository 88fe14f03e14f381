// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "meeting/protocol/room_topic.h"
#include "meeting/transport/mqtt_connection.h"
#include "meeting/transport/room_entry.h"

namespace telemime {

/// An account at a room's broker.
struct RoomLogin {
  MqttServer server;
  RoomAddress room;
  std::string participant;  ///< whose messages it may write; empty: may only watch
  std::string warning;      ///< for the user, while all is well otherwise
};

/// The login that a room's server gave. `ca` as in RoomEntry. Throws Error(input) when it is none.
RoomLogin login_of(const RoomKey& key, const std::filesystem::path& ca);

/// How a program comes into a room: by its link, or by the broker's URL,
/// mqtt://[user:password@]host/tenant/room (options key=FILE, and ca=FILE with mqtts://).
class RoomDoor {
 public:
  using Enter = std::function<RoomKey(const RoomEntry&)>;

  /// `watch`: an account that only reads is enough. `enter`: enter_room(). Throws Error(usage) for a URL that
  /// is none.
  RoomDoor(const std::string& where, bool watch, std::filesystem::path ca, Enter enter = enter_room);
  /// Comes in, or in again: then by the same seat, if the link's server has it. Throws as enter_room() does.
  RoomLogin come_in();
  bool is_link() const { return !entry_.link.empty(); }
  /// Where it leads, without secrets.
  const std::string& shown() const { return shown_; }

 private:
  RoomEntry entry_;
  Enter enter_;
  RoomLogin login_;  ///< of a URL
  std::string shown_;
};

}  // namespace telemime
