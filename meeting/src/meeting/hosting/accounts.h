// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "meeting/protocol/topics.h"

namespace telemime::meeting {

/// An account at the broker of a meeting.
struct BrokerAccount {
  std::string user;                ///< "<meeting>.<participant>"
  std::string password;            ///< the broker's file contains only its hash
  std::vector<std::string> read;   ///< topic filters
  std::vector<std::string> write;  ///< topics or filters
};

/// The id of a participant by number: "p01", "p02", ..., "p100".
std::string participant_id(unsigned number);

/// The password of a participant. It depends only on the key of the meeting, so that a participant who
/// rejoins has the same one.
std::string participant_password(std::string_view key, const std::string& participant);

/// What a rejoin token says: with it a participant gets the same seat again.
struct RejoinToken {
  unsigned number = 0;  ///< of the participant
  bool chair = false;
};
std::string write_rejoin_token(std::string_view key, const RejoinToken& token);
/// Returns nothing when the token was not made with this key.
std::optional<RejoinToken> read_rejoin_token(std::string_view key, std::string_view text);

/// May read the meeting and write the messages of this participant (meeting/docs/protocol.md); chairs may
/// also write the meeting's own topic.
BrokerAccount participant_account(const MeetingAddress& meeting, std::string_view key,
                                  const std::string& participant, bool chair);
/// May read the meeting.
BrokerAccount watcher_account(const MeetingAddress& meeting, std::string_view key);
/// The program's own account: may do everything in the meeting.
BrokerAccount service_account(const MeetingAddress& meeting);

/// "r/<tenant>/<meeting>"
std::string topic_base(const MeetingAddress& meeting);

}  // namespace telemime::meeting
