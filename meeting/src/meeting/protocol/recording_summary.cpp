// SPDX-License-Identifier: Apache-2.0
#include "meeting/protocol/recording_summary.h"

#include <algorithm>

#include "meeting/protocol/messages.h"

namespace telemime::meeting {
namespace {

constexpr std::size_t kMostNames = 16;  // of one participant: memory has a bound

void add_message(RecordedParticipant& person, const RecordedMessage& message) {
  if (message.topic.kind == TopicKind::pose) {
    ++person.frames;
    person.takes_part = true;
    return;
  }
  ++person.others;
  if (message.topic.kind == TopicKind::presence) {
    const auto presence = read_presence(message.payload);
    person.takes_part = person.takes_part || (presence && presence->here);
    return;
  }
  // A state may be what the broker kept of somebody who is gone.
  person.takes_part =
      person.takes_part || (message.topic.kind != TopicKind::state && !message.payload.empty());
  if (message.topic.kind == TopicKind::state && person.names.size() < kMostNames) {
    if (const auto state = read_state(message.payload)) {
      person.names.insert(state->name);
    }
  }
}

}  // namespace

void RecordingSummary::add(const Record& record) {
  end = std::max(end, time_of(record));
  if (const auto* const begin = std::get_if<RecordingStart>(&record)) {
    start = *begin;
  } else if (const auto* const message = std::get_if<RecordedMessage>(&record)) {
    if (message->topic.kind != TopicKind::meeting) {
      add_message(people[message->topic.participant], *message);
    }
  } else if (std::holds_alternative<ConnectionLost>(record)) {
    ++gaps;
  } else if (const auto* const missing = std::get_if<MessagesDropped>(&record)) {
    dropped += missing->count;
  }
}

bool is_wanted(const std::string& participant, const RecordedParticipant& person,
               const std::set<std::string>& wanted) {
  return wanted.empty() || wanted.contains(participant) ||
         std::any_of(person.names.begin(), person.names.end(),
                     [&](const std::string& name) { return wanted.contains(name); });
}

}  // namespace telemime::meeting
