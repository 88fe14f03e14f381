// SPDX-License-Identifier: Apache-2.0
#include "meeting/protocol/recording_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "meeting/protocol/testing.h"
#include "telemime/core/random.h"

namespace telemime::meeting {
namespace {

using Bytes = std::span<const std::uint8_t>;

Bytes bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

const RecordingStart kBegin{{"home", "studio"}, "2026-01-02T03:04:05Z"};

std::string any_text(Random& random, std::size_t longest) {
  std::string text(random.below(static_cast<std::uint32_t>(longest + 1)), '\0');
  for (char& c : text) {
    c = static_cast<char>(random.bits());
  }
  return text;
}

RecordedMessage any_message(Random& random, std::uint64_t at) {
  RecordedMessage message;
  message.at = at;
  message.topic.kind = static_cast<TopicKind>(random.below(6));
  if (message.topic.kind != TopicKind::meeting) {
    message.topic.participant = "p" + std::to_string(random.below(30));
  }
  if (message.topic.kind == TopicKind::board) {
    message.topic.page = static_cast<int>(random.below(kMostBoardPages));
  }
  message.payload = any_text(random, random.below(20) == 0 ? kLongestPayload : 150);
  return message;
}

Record any_record(Random& random, std::uint64_t at) {
  switch (random.below(8)) {
    case 0:
      return ConnectionLost{at, any_text(random, 40)};
    case 1:
      return ConnectionRestored{at};
    case 2:
      return MessagesDropped{at, static_cast<std::uint32_t>(random.bits())};
    default:
      return any_message(random, at);
  }
}

std::vector<Record> any_records(Random& random, std::size_t count) {
  std::vector<Record> records;
  std::uint64_t at = 0;
  for (std::size_t i = 0; i < count; ++i) {
    at += random.below(3) == 0 ? 0 : random.below(1U << 30U);
    records.push_back(any_record(random, at));
  }
  records.push_back(RecordingEnd{at + 1});
  return records;
}

void expect_same(const Record& a, const Record& b) {
  ASSERT_EQ(a.index(), b.index());
  EXPECT_EQ(time_of(a), time_of(b));
  if (const auto* const message = std::get_if<RecordedMessage>(&a)) {
    const auto& other = std::get<RecordedMessage>(b);
    EXPECT_EQ(message->topic.kind, other.topic.kind);
    EXPECT_EQ(message->topic.participant, other.topic.participant);
    EXPECT_EQ(message->topic.page, other.topic.page);
    EXPECT_EQ(message->payload, other.payload);
  } else if (const auto* const lost = std::get_if<ConnectionLost>(&a)) {
    EXPECT_EQ(lost->reason, std::get<ConnectionLost>(b).reason);
  } else if (const auto* const dropped = std::get_if<MessagesDropped>(&a)) {
    EXPECT_EQ(dropped->count, std::get<MessagesDropped>(b).count);
  }
}

/// The file, and where each of its records (behind the start) ends.
struct Written {
  std::string file;
  std::vector<std::size_t> ends;
};

Written written(const std::vector<Record>& records) {
  RecordingEncoder encoder;
  Written out{RecordingEncoder::begin(kBegin), {}};
  for (const Record& record : records) {
    out.file += *encoder.encode(record);
    out.ends.push_back(out.file.size());
  }
  return out;
}

struct Read {
  std::vector<Record> records;  ///< behind the start
  bool started = false;
  bool ended = false;
  std::uint64_t good = 0;
  std::optional<RecordingFault> fault;
};

/// Reads the file from pieces of up to `piece` bytes.
Read read(const std::string& file, std::size_t piece, Random& random) {
  RecordingDecoder decoder;
  Read out;
  for (std::size_t at = 0; at < file.size();) {
    const std::size_t size =
        std::min<std::size_t>(file.size() - at, 1 + random.below(static_cast<std::uint32_t>(piece)));
    decoder.feed(bytes_of(file).subspan(at, size));
    at += size;
    while (auto record = decoder.next()) {
      if (out.started) {
        out.records.push_back(std::move(*record));
      } else {
        out.started = std::holds_alternative<RecordingStart>(*record);
        EXPECT_TRUE(out.started);
      }
    }
  }
  out.ended = decoder.ended();
  out.good = decoder.good();
  out.fault = decoder.fault();
  return out;
}

TEST(RecordingFile, IsReadAsWritten) {
  Random random(1);
  for (int i = 0; i < 60; ++i) {
    const auto records = any_records(random, random.below(60));
    const Read back = read(written(records).file, i % 2 == 0 ? 20 : 100'000, random);
    EXPECT_FALSE(back.fault);
    EXPECT_TRUE(back.ended);
    ASSERT_EQ(back.records.size(), records.size());
    for (std::size_t r = 0; r < records.size(); ++r) {
      expect_same(back.records[r], records[r]);
    }
  }
}

TEST(RecordingFile, BeginsWithItsMeeting) {
  RecordingDecoder decoder;
  decoder.feed(bytes_of(RecordingEncoder::begin(kBegin)));
  const auto first = decoder.next();
  ASSERT_TRUE(first && std::holds_alternative<RecordingStart>(*first));
  const auto& start = std::get<RecordingStart>(*first);
  EXPECT_EQ(start.meeting.tenant, "home");
  EXPECT_EQ(start.meeting.meeting, "studio");
  EXPECT_EQ(start.began, kBegin.began);
  EXPECT_FALSE(decoder.next());
  EXPECT_FALSE(decoder.fault());
}

TEST(RecordingFile, HasTheDocumentedBytes) {
  RecordingEncoder encoder;
  const RecordedMessage message{1, {TopicKind::board, "p1", 3}, "x"};
  const std::string first = *encoder.encode(message);
  const std::string again = *encoder.encode(message);
  EXPECT_EQ(first.size(), 7 + 2 + 2 + again.size()) << "the name comes once";
  EXPECT_EQ(again.size(), 7U + 8 + 1 + 1 + 2 + 1);
  EXPECT_EQ(again.substr(0, 3), std::string("M\x0d\0", 3));
  EXPECT_EQ(again.substr(7), std::string("\1\0\0\0\0\0\0\0\4\3\0\0x", 13));
  // CRC-32 of 4d 0d 00 and these 13 bytes, by Python's zlib.
  EXPECT_EQ(again.substr(3, 4), std::string("\x5f\xa4\xfc\x53", 4));
}

TEST(RecordingFile, TruncatedFileIsReadToItsLastRecord) {
  Random random(2);
  const auto records = any_records(random, 25);
  const Written whole = written(records);
  for (std::size_t size = 0; size < whole.file.size(); ++size) {
    const Read cut = read(whole.file.substr(0, size), 4000, random);
    EXPECT_FALSE(cut.fault) << size;
    EXPECT_FALSE(cut.ended);
    const auto expected = std::upper_bound(whole.ends.begin(), whole.ends.end(), size) - whole.ends.begin();
    ASSERT_EQ(cut.records.size(), static_cast<std::size_t>(expected)) << size;
    EXPECT_LE(cut.good, size);
  }
}

TEST(RecordingFile, DamagedByteEndsIt) {
  Random random(3);
  const auto records = any_records(random, 12);
  const Written whole = written(records);
  for (std::size_t place = kRecordingHead; place < whole.file.size(); ++place) {
    std::string file = whole.file;
    file[place] = static_cast<char>(file[place] ^ (1 << random.below(8)));
    const Read damaged = read(file, 100'000, random);
    EXPECT_LE(damaged.good, place);
    EXPECT_FALSE(damaged.ended);
    const auto before = std::upper_bound(whole.ends.begin(), whole.ends.end(), place) - whole.ends.begin();
    ASSERT_EQ(damaged.records.size(), static_cast<std::size_t>(before)) << place;
    for (std::size_t r = 0; r < damaged.records.size(); ++r) {
      expect_same(damaged.records[r], records[r]);
    }
  }
}

TEST(RecordingFile, TailOfZerosIsDamage) {
  Random random(4);
  const Written whole = written({ConnectionRestored{5}, RecordingEnd{6}});
  for (const std::size_t keep : {whole.ends[0], whole.ends[0] + 3, whole.ends[1]}) {
    const Read padded = read(whole.file.substr(0, keep) + std::string(4096, '\0'), 512, random);
    EXPECT_EQ(padded.fault, RecordingFault::damaged) << keep;
    EXPECT_GE(padded.records.size(), 1U);
  }
}

TEST(RecordingFile, OtherFilesAreRejected) {
  Random random(5);
  EXPECT_EQ(read("{\"header\":1}", 5, random).fault, RecordingFault::no_recording);
  EXPECT_EQ(read("TROOM\n\x1a", 5, random).fault, RecordingFault::no_recording) << "changed line ends";
  std::string newer = RecordingEncoder::begin(kBegin);
  newer[8] = 2;
  EXPECT_EQ(read(newer, 5, random).fault, RecordingFault::other_version);
  EXPECT_FALSE(read("", 1, random).fault);
}

TEST(RecordingFile, UnknownKindsAreSkipped) {
  Random random(6);
  const std::string begin = RecordingEncoder::begin(kBegin);
  // Kind "Z" with the body "hi"; the checksum by Python's zlib.
  const std::string unknown = std::string("Z\2\0\xaf\xd0\xc2\x87", 7) + "hi";
  RecordingEncoder encoder;
  const Read back = read(begin + unknown + *encoder.encode(RecordingEnd{9}), 100, random);
  EXPECT_FALSE(back.fault);
  EXPECT_TRUE(back.ended);
}

TEST(RecordingFile, NoiseIsReadOrRejected) {
  Random random(7);
  const std::string begin = RecordingEncoder::begin(kBegin);
  for (int i = 0; i < 3000; ++i) {
    const Read noise = read((i % 2 == 0 ? begin : "") + any_text(random, 200), 64, random);
    EXPECT_TRUE(noise.records.empty());
  }
}

bool refuses(RecordingEncoder& encoder, const Record& record) {
  return !error_of([&] { encoder.encode(record); }, ErrorKind::usage).empty();
}

TEST(RecordingFile, InvalidRecordsAreNotWritten) {
  RecordingEncoder encoder;
  const RecordedMessage well{10, {TopicKind::chat, "p1", 0}, "{}"};
  EXPECT_FALSE(refuses(encoder, well));
  EXPECT_TRUE(refuses(encoder, ConnectionRestored{9})) << "time goes back";
  EXPECT_TRUE(refuses(encoder, ConnectionRestored{kTimeEnd}));
  EXPECT_TRUE(refuses(encoder, kBegin));
  EXPECT_TRUE(refuses(encoder, RecordedMessage{10, {TopicKind::chat, "P/1", 0}, ""}));
  EXPECT_TRUE(refuses(encoder, RecordedMessage{10, {TopicKind::board, "p1", 64}, ""}));
  EXPECT_TRUE(refuses(encoder, RecordedMessage{10, {TopicKind::chat, "p1", 0}, std::string(16385, 'x')}));
  EXPECT_FALSE(refuses(encoder, RecordingEnd{10}));
  EXPECT_TRUE(refuses(encoder, RecordingEnd{10}));
  EXPECT_THROW(RecordingEncoder::begin({{"", "studio"}, ""}), Error);
  EXPECT_THROW(RecordingEncoder::begin({{"home", "studio"}, "now\n"}), Error);
}

TEST(RecordingFile, NumberOfParticipantsIsBounded) {
  RecordingEncoder encoder;
  std::set<std::size_t> taken;
  for (std::size_t i = 0; i < kMostRecordedParticipants + 5; ++i) {
    if (encoder.encode(RecordedMessage{i, {TopicKind::pose, "p" + std::to_string(i), 0}, ""})) {
      taken.insert(i);
    }
  }
  EXPECT_EQ(taken.size(), kMostRecordedParticipants);
  EXPECT_TRUE(encoder.encode(RecordedMessage{2000, {TopicKind::pose, "p0", 0}, ""})) << "who is known";
}

}  // namespace
}  // namespace telemime::meeting
