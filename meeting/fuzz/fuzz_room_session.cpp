// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "meeting/protocol/session_file.h"
#include "meeting/protocol/session_replay.h"

// Nothing may be thrown at all. What is read can be written, and what is replayed can be read.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  telemime::SessionDecoder decoder;
  telemime::SessionEncoder encoder;
  telemime::ReplayPart part(1.5, UINT16_MAX, 1000);
  const std::size_t half = size / 2;
  for (const std::span<const std::uint8_t> piece :
       {std::span(data, half), std::span(data + half, size - half)}) {
    decoder.feed(piece);
    while (const auto record = decoder.next()) {
      if (std::holds_alternative<telemime::SessionStart>(*record)) {
        telemime::SessionEncoder::begin(std::get<telemime::SessionStart>(*record));
      } else if (!encoder.encode(*record)) {
        std::abort();
      }
      if (const auto* const message = std::get_if<telemime::SessionMessage>(&*record)) {
        part.step(*message);
        telemime::page_with_epoch(message->payload, 7);
      }
    }
  }
  if (decoder.good() > size) {
    std::abort();
  }
  return 0;
}
