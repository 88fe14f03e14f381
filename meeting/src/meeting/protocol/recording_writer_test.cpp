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

#include "meeting/protocol/messages.h"
#include "meeting/protocol/recording_reader.h"
#include "meeting/protocol/testing.h"
#include "telemime/core/errors.h"
#include "telemime/core/scratch_folder.h"

namespace telemime::meeting {
namespace {

const RecordingStart kStart{{"home", "studio"}, "2026-01-02T03:04:05Z"};

RecordedMessage message(std::uint64_t at, TopicKind kind, std::size_t size) {
  return {at, {kind, "p1", 0}, std::string(size, 'x')};
}

std::string refusal(const std::string& file) {
  return error_of([&] { inspect_recording(file); }, ErrorKind::input);
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
  EXPECT_EQ(about.st_mode & 0777U, 0600U) << "only its owner may read it";
}

TEST(RecordingWriter, DroppedMessageDoesNotSyncTheDisk) {
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

TEST(RecordingWriter, DoesNotOverwriteAFile) {
  const ScratchFolder folder;
  std::ofstream(folder.file("a.troom")) << "precious";
  EXPECT_THROW(new_recording_file(folder.file("a.troom")), Error);
  EXPECT_THROW(new_recording_file(folder.file("none/a.troom")), Error);
  EXPECT_EQ(content_of(folder.file("a.troom")), "precious");
}

TEST(RecordingWriter, SlowDiskDropsPosesFirstAndBlocksNobody) {
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
  EXPECT_EQ(writer.dropped(), poses) << "other messages have more space than poses";
  for (int i = 0; i < 1000; ++i) {
    writer.add(message(3, TopicKind::board, kLongestPayload));
  }
  EXPECT_GT(writer.dropped(), poses) << "memory is bounded";
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

TEST(RecordingWriter, FailureAtTheEndIsReported) {
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

TEST(RecordingWriter, FullDiskIsReportedAndKeepsTheStart) {
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
  const std::string text = error_of([&] { writer.end(6000); }, ErrorKind::output);
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, handler);
  EXPECT_NE(text.find(file + " cannot be written"), std::string::npos) << text;
  EXPECT_LE(std::filesystem::file_size(file), 20'000U);
  EXPECT_EQ(std::filesystem::file_size(file), writer.bytes()) << "whole records only";
  EXPECT_FALSE(records_of(file).empty());
  EXPECT_EQ(inspect_recording(file).complaint,
            "the recording was not closed properly; its end may be missing");
}

TEST(RecordingReader, ReportsWhatIsWrongWithAFile) {
  const ScratchFolder folder;
  const std::string file = folder.file("a.troom");
  const auto put = [&](const std::string& bytes) {
    std::ofstream(file, std::ios::binary | std::ios::trunc) << bytes;
  };
  EXPECT_TRUE(contains(refusal(file), "No such file"));
  EXPECT_TRUE(contains(refusal(folder.path().string()), "it is a folder"));
  put("");
  EXPECT_TRUE(contains(refusal(file), "it is empty"));
  put("{\"header\": {}}\n");
  EXPECT_TRUE(contains(refusal(file), "it is not a recording of a meeting"));
  const std::string begin = RecordingEncoder::begin(kStart);
  put(begin.substr(0, 30));
  EXPECT_TRUE(contains(refusal(file), "ends before anything"));
  std::string newer = begin;
  newer[8] = 9;
  put(newer);
  EXPECT_TRUE(contains(refusal(file), "does not know its version"));
  RecordingEncoder encoder;
  const std::string more = *encoder.encode(message(1, TopicKind::pose, 10));
  put(begin + more);
  EXPECT_EQ(inspect_recording(file).complaint,
            "the recording was not closed properly; its end may be missing");
  put(begin + more + more.substr(0, 5));
  EXPECT_EQ(inspect_recording(file).complaint,
            "it is truncated; the last 5 bytes are not a whole record and are ignored");
  put(begin + more + std::string(100, '\0'));
  EXPECT_EQ(inspect_recording(file).complaint,
            "it is damaged at byte " + std::to_string(begin.size() + more.size()) + "; the rest is ignored");
  put(begin + more + *encoder.encode(RecordingEnd{2}));
  EXPECT_EQ(inspect_recording(file).complaint, "");
}

RecordedMessage sent(std::uint64_t at, const std::string& who, TopicKind kind, const std::string& payload) {
  return {at, {kind, who, 0}, payload};
}

std::string state(const std::string& name) {
  ParticipantState state;
  state.name = name;
  return write_state(state);
}

TEST(RecordingSummary, KnowsWhoTookPart) {
  RecordingSummary summary;
  summary.add(RecordingStart{{"home", "studio"}, "today"});
  summary.add(sent(1, "", TopicKind::meeting, "{}"));
  summary.add(sent(1, "gone", TopicKind::presence, write_presence({false, 3})));
  summary.add(sent(1, "gone", TopicKind::state, ""));
  summary.add(sent(1, "lost", TopicKind::presence, write_presence({false, 4})));
  summary.add(sent(1, "lost", TopicKind::state, state("Who was killed")));
  summary.add(sent(2, "p1", TopicKind::presence, write_presence({true, 3})));
  summary.add(sent(3, "p1", TopicKind::state, state("Ana")));
  summary.add(sent(4, "p1", TopicKind::state, state("Ana B")));
  summary.add(sent(5, "p2", TopicKind::pose, "?"));
  summary.add(sent(6, "p3", TopicKind::chat, "?"));
  summary.add(ConnectionLost{7, "why"});
  summary.add(ConnectionRestored{8});
  summary.add(MessagesDropped{9, 4});
  summary.add(RecordingEnd{12});
  EXPECT_EQ(summary.start.meeting.meeting, "studio");
  ASSERT_EQ(summary.people.size(), 5U);
  EXPECT_FALSE(summary.people.at("gone").takes_part) << "left earlier";
  EXPECT_FALSE(summary.people.at("lost").takes_part) << "a retained state is not a sign of life";
  EXPECT_TRUE(summary.people.at("p1").takes_part);
  EXPECT_EQ(summary.people.at("p1").names, (std::set<std::string>{"Ana", "Ana B"}));
  EXPECT_EQ(summary.people.at("p1").others, 3U);
  EXPECT_EQ(summary.people.at("p2").frames, 1U);
  EXPECT_TRUE(summary.people.at("p2").takes_part);
  EXPECT_TRUE(summary.people.at("p3").takes_part);
  EXPECT_EQ(summary.gaps, 1U);
  EXPECT_EQ(summary.dropped, 4U);
  EXPECT_EQ(summary.end, 12U);
}

TEST(RecordingSummary, PeopleAreWantedByNameOrParticipant) {
  const RecordedParticipant ana{{"Ana", "Ana B"}, 0, 0, true};
  EXPECT_TRUE(is_wanted("p1", ana, {}));
  EXPECT_TRUE(is_wanted("p1", ana, {"p1"}));
  EXPECT_TRUE(is_wanted("p1", ana, {"Bo", "Ana B"}));
  EXPECT_FALSE(is_wanted("p1", ana, {"Bo"}));
}

}  // namespace
}  // namespace telemime::meeting
