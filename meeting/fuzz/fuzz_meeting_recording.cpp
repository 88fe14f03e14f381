// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "meeting/protocol/participant_replay.h"
#include "meeting/protocol/recording_file.h"

// Nothing may be thrown at all. What is read can be written, and what is replayed can be read.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  telemime::meeting::RecordingDecoder decoder;
  telemime::meeting::RecordingEncoder encoder;
  telemime::meeting::ParticipantReplay part(1.5, UINT16_MAX, 1000);
  const std::size_t half = size / 2;
  for (const std::span<const std::uint8_t> piece :
       {std::span(data, half), std::span(data + half, size - half)}) {
    decoder.feed(piece);
    while (const auto record = decoder.next()) {
      if (std::holds_alternative<telemime::meeting::RecordingStart>(*record)) {
        telemime::meeting::RecordingEncoder::begin(std::get<telemime::meeting::RecordingStart>(*record));
      } else if (!encoder.encode(*record)) {
        std::abort();
      }
      if (const auto* const message = std::get_if<telemime::meeting::RecordedMessage>(&*record)) {
        part.step(*message);
        telemime::meeting::page_with_epoch(message->payload, 7);
      }
    }
  }
  if (decoder.good() > size) {
    std::abort();
  }
  return 0;
}
