// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>
#include <string_view>

#include "meeting/protocol/messages.h"
#include "meeting/protocol/topics.h"

using namespace telemime::meeting;

// Nothing is ever thrown. A message that was read can be written, and is read again.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  if (const auto presence = read_presence(text)) {
    if (!read_presence(write_presence(*presence))) {
      std::abort();
    }
  }
  if (const auto state = read_state(text)) {
    if (!read_state(write_state(*state))) {
      std::abort();
    }
  }
  const MeetingAddress meeting{"home", "studio"};
  if (const auto topic = read_topic(meeting, text)) {
    if (topic_text(meeting, *topic) != text) {
      std::abort();
    }
  }
  return 0;
}
