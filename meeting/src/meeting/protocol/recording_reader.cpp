// SPDX-License-Identifier: Apache-2.0
#include "meeting/protocol/recording_reader.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <system_error>
#include <utility>

#include "meeting/protocol/messages.h"
#include "meeting/protocol/pose_detail.h"
#include "telemime/core/errors.h"

namespace telemime::meeting {
namespace {

constexpr std::size_t kPiece = 65536;   // bytes
constexpr std::size_t kMostNames = 16;  // of one participant: memory needs a bound

[[noreturn]] void unusable(const std::filesystem::path& file, const std::string& reason,
                           const std::string& remedy = "") {
  throw Error(ErrorKind::input, file.string() + " cannot be used: " + reason, remedy);
}

void add_message(RecordedParticipant& person, const RecordedMessage& message) {
  if (message.topic.kind == TopicKind::pose) {
    person.frames += is_pose_detail(message.payload) ? 0 : 1;
    person.takes_part = true;
    return;
  }
  ++person.others;
  if (message.topic.kind == TopicKind::presence) {
    const auto presence = read_presence(message.payload);
    person.takes_part = person.takes_part || (presence && presence->here);
  } else if (message.topic.kind != TopicKind::state) {
    person.takes_part = person.takes_part || !message.payload.empty();
  } else if (const auto state = read_state(message.payload); state && person.names.size() < kMostNames) {
    person.names.insert(state->name);  // the state may be a retained one of a participant who has left
  }
}

}  // namespace

RecordingReader::RecordingReader(std::filesystem::path file) : file_(std::move(file)) {
  std::error_code error;
  if (std::filesystem::is_directory(file_, error)) {
    unusable(file_, "it is a folder");
  }
  errno = 0;
  in_.open(file_, std::ios::binary);
  if (!in_) {
    unusable(file_, std::generic_category().message(errno));
  }
  start_ = next();
  if (start_) {
    return;
  }
  if (size_ == 0) {
    unusable(file_, "it is empty");
  }
  if (decoder_.fault() == RecordingFault::other_version) {
    unusable(file_, "this program does not know its version of recordings",
             "A newer telemime may have written it.");
  }
  if (!decoder_.fault()) {
    unusable(file_, "it ends before anything was recorded");
  }
  unusable(file_, "it is not a recording of a meeting", "telemime meeting record writes recordings.");
}

std::optional<Record> RecordingReader::next() {
  if (start_) {
    return std::exchange(start_, std::nullopt);
  }
  std::array<char, kPiece> piece{};
  for (;;) {
    if (auto record = decoder_.next()) {
      return record;
    }
    if (decoder_.fault() || in_.eof()) {
      return std::nullopt;
    }
    in_.read(piece.data(), piece.size());
    if (in_.bad()) {
      unusable(file_, "reading it failed");
    }
    const auto count = static_cast<std::size_t>(in_.gcount());
    size_ += count;
    decoder_.feed({reinterpret_cast<const std::uint8_t*>(piece.data()), count});
  }
}

std::string RecordingReader::complaint() const {
  if (decoder_.fault()) {
    return "it is damaged at byte " + std::to_string(decoder_.good()) + "; the rest is ignored";
  }
  if (size_ != decoder_.good()) {
    return "it is truncated; the last " + std::to_string(size_ - decoder_.good()) +
           " bytes are not a whole record and are ignored";
  }
  return decoder_.ended() ? "" : "the recording was not closed properly; its end may be missing";
}

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

RecordingReport inspect_recording(const std::filesystem::path& file) {
  RecordingReader reader(file);
  RecordingReport report;
  while (const auto record = reader.next()) {
    report.summary.add(*record);
  }
  report.complaint = reader.complaint();
  return report;
}

}  // namespace telemime::meeting
