// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "meeting/protocol/room_messages.h"
#include "meeting/protocol/room_topic.h"

// Nothing may be thrown at all. What is read can be written, and is read again.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  if (const auto presence = telemime::read_presence(text)) {
    if (!telemime::read_presence(telemime::write_presence(*presence))) {
      std::abort();
    }
  }
  if (const auto state = telemime::read_state(text)) {
    if (!telemime::read_state(telemime::write_state(*state))) {
      std::abort();
    }
  }
  const telemime::RoomAddress room{"home", "studio"};
  if (const auto topic = telemime::read_topic(room, text)) {
    if (telemime::topic_text(room, *topic) != text) {
      std::abort();
    }
  }
  return 0;
}
