// SPDX-License-Identifier: Apache-2.0
// Recording a meeting.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "broker.h"
#include "checks.h"
#include "feeder.h"
#include "meeting/protocol/recording_reader.h"
#include "meeting/transport/senders.h"
#include "recordings.h"
#include "telemime/core/scratch_folder.h"

namespace telemime::meeting::test_support {
namespace {

TEST(RecordedMeeting, ScriptReadsTheSameAsTheProgram) {
  const ScratchFolder folder;
  const std::string file = write_test_recording(folder.file("a.troom"), 2, 20, 500);
  const std::string script = std::string(TELEMIME_SOURCE_DIR) + "/scripts/recording.py";
  run({"/bin/sh", "-c", "python3 " + script + " " + file + " --lines > " + folder.file("lines")});
  std::ifstream lines(folder.file("lines"));
  std::string line;
  for (const Record& record : records_of(file)) {
    ASSERT_TRUE(std::getline(lines, line));
    const auto json = nlohmann::json::parse(line);
    EXPECT_EQ(json.value("at_us", std::uint64_t{0}), time_of(record));
    if (const auto* const message = std::get_if<RecordedMessage>(&record)) {
      EXPECT_EQ(json.at("participant"), message->topic.participant);
      EXPECT_EQ(json.value("page", 0), message->topic.page);
      const auto text = json.at("payload").get<std::string>();
      if (message->topic.kind == TopicKind::pose) {
        EXPECT_EQ(text.size(), 2 * message->payload.size());
        EXPECT_EQ(std::stoi(text.substr(4, 2), nullptr, 16), static_cast<unsigned char>(message->payload[2]));
      } else {
        EXPECT_EQ(text, message->payload);
      }
    }
  }
  EXPECT_FALSE(std::getline(lines, line));
}

TEST(RecordedMeeting, DeadBrokerLeavesAGap) {
  const ScratchFolder folder;
  const std::string file = folder.file("a.troom");
  Broker broker;
  const auto sender = make_sender(broker.url() + "?participant=p01", kAllSenderKinds);
  const Feeder feeder(*sender);
  Recording recording(broker.url(), file);
  ASSERT_TRUE(recording.has(10));
  broker.kill();
  ASSERT_TRUE(recording.reported("the connection to the meeting is lost"));
  const std::uint64_t before = recording.messages();
  broker.start();
  ASSERT_TRUE(recording.reported("the connection to the meeting is restored"));
  ASSERT_TRUE(recording.has(before + 10));
  recording.end();
  const RecordingReport report = inspect_recording(file);
  EXPECT_EQ(report.summary.gaps, 1U);
  EXPECT_EQ(report.complaint, "");
  std::string order;
  std::uint64_t last = 0;
  for (const Record& record : records_of(file)) {
    EXPECT_GE(time_of(record), last);
    last = time_of(record);
    const char letter = "SmLBDE"[record.index()];
    order += order.ends_with(letter) ? "" : std::string(1, letter);
  }
  EXPECT_EQ(order, "SmLBmE");
}

TEST(RecordedMeeting, MeetingThatCannotBeReadIsReported) {
  const ScratchFolder folder;
  const std::string account = "studio.watch:secretword@";
  const Broker broker({{"studio.watch", "secretword", kWatches}});
  const auto refusal = [&](const std::string& where) {
    MeetingLogin login(where, true, "", {});
    MeetingRecorder recorder(
        login, [] { return false; }, [](const std::string&) {});
    RecordingWriter writer([](std::string_view) {}, {recorder.log_in().meeting, ""});
    return error_of([&] { recorder.record(writer); }, ErrorKind::input);
  };
  EXPECT_NE(refusal(broker.url("studio.watch:guess@")).find("rejects the user name or password"),
            std::string::npos);
  EXPECT_NE(refusal("mqtt://127.0.0.1:1/home/studio").find("no program is listening there"),
            std::string::npos);
  const std::string file = folder.file("a.troom");
  Recording recording(broker.url(account), file);
  const Subscriber subscriber(broker.port(), "studio.watch", "secretword");
  ASSERT_TRUE(comes_true([&] { return broker.log().find("record-") != std::string::npos; }));
  recording.end();
  EXPECT_EQ(content_of(file).find("secretword"), std::string::npos) << "passwords are never recorded";
  EXPECT_NE(content_of(file).find("studio"), std::string::npos);
}

}  // namespace
}  // namespace telemime::meeting::test_support
