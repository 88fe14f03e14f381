// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>

#include "meeting/protocol/meeting_info.h"
#include "meeting/protocol/participant_replay.h"
#include "meeting/protocol/recording_file.h"

using namespace telemime::meeting;

// Nothing is ever thrown. A recording that was read can be written, and a replayed message can be read.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  RecordingDecoder decoder;
  RecordingEncoder encoder;
  ParticipantReplay part(1.5, UINT16_MAX, 1000);
  const std::size_t half = size / 2;
  for (const std::span<const std::uint8_t> piece :
       {std::span(data, half), std::span(data + half, size - half)}) {
    decoder.feed(piece);
    while (const auto record = decoder.next()) {
      if (std::holds_alternative<RecordingStart>(*record)) {
        RecordingEncoder::begin(std::get<RecordingStart>(*record));
      } else if (!encoder.encode(*record)) {
        std::abort();
      }
      if (const auto* const message = std::get_if<RecordedMessage>(&*record)) {
        part.step(*message);
        page_with_epoch(message->payload, 7);
      }
    }
  }
  if (decoder.good() > size) {
    std::abort();
  }
  return 0;
}
