// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "meeting/protocol/messages.h"
#include "meeting/protocol/topics.h"

// Nothing may be thrown at all. What is read can be written, and is read again.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  if (const auto presence = telemime::meeting::read_presence(text)) {
    if (!telemime::meeting::read_presence(telemime::meeting::write_presence(*presence))) {
      std::abort();
    }
  }
  if (const auto state = telemime::meeting::read_state(text)) {
    if (!telemime::meeting::read_state(telemime::meeting::write_state(*state))) {
      std::abort();
    }
  }
  const telemime::meeting::MeetingAddress meeting{"home", "studio"};
  if (const auto topic = telemime::meeting::read_topic(meeting, text)) {
    if (telemime::meeting::topic_text(meeting, *topic) != text) {
      std::abort();
    }
  }
  return 0;
}
