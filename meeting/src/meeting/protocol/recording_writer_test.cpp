// SPDX-License-Identifier: Apache-2.0
#include "meeting/protocol/recording_writer.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <future>
#include <thread>

#include "meeting/protocol/recording_reader.h"
#include "telemime/core/errors.h"
#include "telemime/core/scratch_folder.h"

namespace telemime::meeting {
namespace {

const RecordingStart kStart{{"home", "studio"}, "2026-01-02T03:04:05Z"};

RecordedMessage message(std::uint64_t at, TopicKind kind, std::size_t size) {
  return {at, {kind, "p1", 0}, std::string(size, 'x')};
}

std::vector<Record> records_of(const std::string& file) {
  RecordingReader reader(file);
  std::vector<Record> records;
  while (auto record = reader.next()) {
    records.push_back(std::move(*record));
  }
  return records;
}

std::string words_of(const std::string& file) {
  try {
    inspect_recording(file);
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::input);
    return e.what();
  }
  return "";
}

TEST(RecordingWriter, WhatIsAddedIsInTheFile) {
  const ScratchFolder folder;
  const std::string file = folder.file("a.troom");
  RecordingWriter writer(new_recording_file(file), kStart);
  for (std::uint64_t i = 0; i < 5000; ++i) {
    writer.add(message(i, TopicKind::pose, 111));
  }
  writer.add(ConnectionLost{5000, "gone"});
  writer.end(6000);
  EXPECT_EQ(writer.messages(), 5000U);
  EXPECT_EQ(writer.dropped(), 0U);
  EXPECT_EQ(writer.bytes(), std::filesystem::file_size(file));
  const auto records = records_of(file);
  ASSERT_EQ(records.size(), 5003U);
  for (std::uint64_t i = 0; i < 5000; ++i) {
    EXPECT_EQ(time_of(records[1 + i]), i);
  }
  EXPECT_TRUE(std::holds_alternative<RecordingEnd>(records.back()));
  EXPECT_EQ(inspect_recording(file).complaint, "");
  struct stat about {};
  ASSERT_EQ(::stat(file.c_str(), &about), 0);
  EXPECT_EQ(about.st_mode & 0777U, 0600U) << "what people do and say is nobody else's";
}

TEST(RecordingWriter, WhatIsLeftOutIsNoReasonToBringAllToTheDisk) {
  std::vector<std::size_t> sizes;
  const auto write = [&](std::string_view bytes) { sizes.push_back(bytes.size()); };
  {
    RecordingWriter writer(write, kStart);
    RecordedMessage one = message(1, TopicKind::pose, 10);
    RecordingEncoder encoder;
    std::uint64_t size = writer.bytes();
    for (std::size_t i = 0; i < kMostRecordedParticipants; ++i) {
      one.topic.participant = "p" + std::to_string(i);
      writer.add(one);
      size += encoder.encode(one)->size();
    }
    while (writer.bytes() < size) {
      std::this_thread::yield();
    }
    one.topic.participant = "late";
    writer.add(one);
    while (writer.dropped() == 0) {
      std::this_thread::yield();
    }
  }
  EXPECT_EQ(std::count(sizes.begin(), sizes.end(), 0U), 0);
}

TEST(RecordingWriter, AnotherFileIsNotWrittenOver) {
  const ScratchFolder folder;
  std::ofstream(folder.file("a.troom")) << "precious";
  EXPECT_THROW(new_recording_file(folder.file("a.troom")), Error);
  EXPECT_THROW(new_recording_file(folder.file("none/a.troom")), Error);
  std::string content;
  std::ifstream(folder.file("a.troom")) >> content;
  EXPECT_EQ(content, "precious");
}

TEST(RecordingWriter, ASlowDiskLosesPosesFirstAndBlocksNobody) {
  const ScratchFolder folder;
  const std::string file = folder.file("a.troom");
  std::promise<void> stuck;
  std::promise<void> go_on;
  const std::shared_future<void> may_go_on = go_on.get_future().share();
  int writes = 0;
  RecordingWriter writer(
      [&, write = new_recording_file(file)](std::string_view bytes) {
        if (++writes == 2) {
          stuck.set_value();
          may_go_on.wait();
        }
        write(bytes);
      },
      kStart);
  writer.add(message(0, TopicKind::pose, 100));
  stuck.get_future().wait();
  const std::size_t kPoses = kWriterQueueBytes / 100;
  for (std::size_t i = 0; i < kPoses; ++i) {
    writer.add(message(1, TopicKind::pose, 100));
  }
  EXPECT_GT(writer.dropped(), kPoses / 3);
  const std::uint64_t poses = writer.dropped();
  writer.add(message(2, TopicKind::chat, 50));
  EXPECT_EQ(writer.dropped(), poses) << "words have more room than poses";
  for (int i = 0; i < 1000; ++i) {
    writer.add(message(3, TopicKind::board, kLongestPayload));
  }
  EXPECT_GT(writer.dropped(), poses) << "memory has a bound";
  go_on.set_value();
  writer.end(9);
  std::uint64_t missing = 0;
  std::uint64_t there = 0;
  for (const Record& record : records_of(file)) {
    if (const auto* const dropped = std::get_if<MessagesDropped>(&record)) {
      missing += dropped->count;
    }
    there += std::holds_alternative<RecordedMessage>(record) ? 1 : 0;
  }
  EXPECT_EQ(missing, writer.dropped());
  EXPECT_EQ(there, writer.messages());
  EXPECT_EQ(missing + there, 1 + kPoses + 1 + 1000);
}

TEST(RecordingWriter, WhatTheDiskRefusesAtTheEndIsTold) {
  RecordingWriter writer(
      [](std::string_view bytes) {
        if (bytes.empty()) {
          throw Error(ErrorKind::output, "the disk is full");
        }
      },
      kStart);
  writer.add(message(0, TopicKind::pose, 100));
  EXPECT_THROW(writer.end(1), Error);
}

TEST(RecordingWriter, AFullDiskIsToldAndKeepsWhatIsThere) {
  const ScratchFolder folder;
  const std::string file = folder.file("a.troom");
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{20'000, before.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  RecordingWriter writer(new_recording_file(file), kStart);
  for (std::uint64_t i = 0; i < 5000 && !writer.failure(); ++i) {
    writer.add(message(i, TopicKind::pose, 111));
  }
  std::string words;
  try {
    writer.end(6000);
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::output);
    words = e.what();
  }
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, handler);
  EXPECT_NE(words.find(file + " cannot be written"), std::string::npos) << words;
  EXPECT_LE(std::filesystem::file_size(file), 20'000U);
  EXPECT_EQ(std::filesystem::file_size(file), writer.bytes()) << "whole records only";
  EXPECT_FALSE(records_of(file).empty());
  EXPECT_EQ(inspect_recording(file).complaint,
            "the recording was not ended in order; its end may be missing");
}

TEST(RecordingReader, SaysWhatIsWrong) {
  const ScratchFolder folder;
  const std::string file = folder.file("a.troom");
  const auto put = [&](const std::string& bytes) {
    std::ofstream(file, std::ios::binary | std::ios::trunc) << bytes;
  };
  EXPECT_NE(words_of(file).find("No such file"), std::string::npos);
  EXPECT_NE(words_of(folder.path().string()).find("it is a folder"), std::string::npos);
  put("");
  EXPECT_NE(words_of(file).find("it is empty"), std::string::npos);
  put("{\"header\": {}}\n");
  EXPECT_NE(words_of(file).find("it is no recording of a room"), std::string::npos);
  const std::string begin = RecordingEncoder::begin(kStart);
  put(begin.substr(0, 30));
  EXPECT_NE(words_of(file).find("breaks off"), std::string::npos);
  std::string newer = begin;
  newer[8] = 9;
  put(newer);
  EXPECT_NE(words_of(file).find("another version"), std::string::npos);
  RecordingEncoder encoder;
  const std::string more = *encoder.encode(message(1, TopicKind::pose, 10));
  put(begin + more);
  EXPECT_EQ(inspect_recording(file).complaint,
            "the recording was not ended in order; its end may be missing");
  put(begin + more + more.substr(0, 5));
  EXPECT_EQ(inspect_recording(file).complaint,
            "its end is cut off; 5 bytes that are no whole record are left out");
  put(begin + more + std::string(100, '\0'));
  EXPECT_EQ(inspect_recording(file).complaint, "it is damaged at byte " +
                                                   std::to_string(begin.size() + more.size()) +
                                                   "; what comes from there on is left out");
  put(begin + more + *encoder.encode(RecordingEnd{2}));
  EXPECT_EQ(inspect_recording(file).complaint, "");
}

}  // namespace
}  // namespace telemime::meeting
