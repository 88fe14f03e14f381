// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "meeting/protocol/topics.h"

namespace telemime::meeting {

/// An account at the room's broker.
struct BrokerAccount {
  std::string user;                ///< "<room>.<participant>"
  std::string password;            ///< the broker's file holds only its hash
  std::vector<std::string> read;   ///< filters of topics
  std::vector<std::string> write;  ///< topics or filters
};

/// "p01", "p02", ..., "p100": the id of the participant of that number.
std::string participant_id(unsigned number);

/// The password of a participant. It follows from the room's key alone, so that a seat that is given back has
/// the same one.
std::string participant_password(std::string_view key, const std::string& participant);

/// What a participant shows to get their seat again.
struct RejoinToken {
  unsigned number = 0;  ///< of the participant
  bool chair = false;
};
std::string write_rejoin_token(std::string_view key, const RejoinToken& way);
/// Nothing when it was not made with this key.
std::optional<RejoinToken> read_rejoin_token(std::string_view key, std::string_view text);

/// May read the room and write what participants say (docs/room-protocol.md), as themselves; chairs may also
/// write what the room is.
BrokerAccount participant_account(const MeetingAddress& meeting, std::string_view key,
                                  const std::string& participant, bool chair);
/// May read the room.
BrokerAccount watcher_account(const MeetingAddress& meeting, std::string_view key);
/// May do all in the room: the program's own.
BrokerAccount service_account(const MeetingAddress& meeting);

/// "r/<tenant>/<room>"
std::string topic_base(const MeetingAddress& meeting);

}  // namespace telemime::meeting
