// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "meeting/protocol/recording_file.h"

namespace telemime::meeting {

/// What a recording holds of one participant.
struct RecordedParticipant {
  std::set<std::string> names;  ///< of their states, as far as these can be read
  std::uint64_t frames = 0;
  std::uint64_t others = 0;  ///< messages that are no frame
  bool takes_part = false;   ///< was here, or said something: there is something to be replayed
};

/// What a recording holds, from its records.
struct RecordingSummary {
  RecordingStart start;
  std::map<std::string, RecordedParticipant> people;  ///< by their participants' names
  std::uint64_t end = 0;                              ///< us
  std::size_t gaps = 0;                               ///< in which nothing could be heard
  std::uint64_t dropped = 0;                          ///< messages

  void add(const Record& record);
};

/// Whether one of `wanted` is the participant, or one of their names. Everybody is wanted when nobody is
/// named.
bool is_wanted(const std::string& participant, const RecordedParticipant& person,
               const std::set<std::string>& wanted);

}  // namespace telemime::meeting
