// SPDX-License-Identifier: Apache-2.0
#include "meeting/protocol/session_summary.h"

#include <algorithm>

#include "meeting/protocol/room_messages.h"

namespace telemime {
namespace {

constexpr std::size_t kMostNames = 16;  // of one participant: memory has a bound

void add_message(RecordedPerson& person, const SessionMessage& message) {
  if (message.topic.kind == RoomTopicKind::pose) {
    ++person.frames;
    person.takes_part = true;
    return;
  }
  ++person.others;
  if (message.topic.kind == RoomTopicKind::presence) {
    const auto presence = read_presence(message.payload);
    person.takes_part = person.takes_part || (presence && presence->here);
    return;
  }
  // A state may be what the broker kept of somebody who is gone.
  person.takes_part =
      person.takes_part || (message.topic.kind != RoomTopicKind::state && !message.payload.empty());
  if (message.topic.kind == RoomTopicKind::state && person.names.size() < kMostNames) {
    if (const auto state = read_state(message.payload)) {
      person.names.insert(state->name);
    }
  }
}

}  // namespace

void SessionSummary::add(const SessionRecord& record) {
  end = std::max(end, time_of(record));
  if (const auto* const begin = std::get_if<SessionStart>(&record)) {
    start = *begin;
  } else if (const auto* const message = std::get_if<SessionMessage>(&record)) {
    if (message->topic.kind != RoomTopicKind::room) {
      add_message(people[message->topic.participant], *message);
    }
  } else if (std::holds_alternative<SessionLost>(record)) {
    ++gaps;
  } else if (const auto* const missing = std::get_if<SessionDropped>(&record)) {
    dropped += missing->count;
  }
}

bool is_wanted(const std::string& participant, const RecordedPerson& person,
               const std::set<std::string>& wanted) {
  return wanted.empty() || wanted.contains(participant) ||
         std::any_of(person.names.begin(), person.names.end(),
                     [&](const std::string& name) { return wanted.contains(name); });
}

}  // namespace telemime
