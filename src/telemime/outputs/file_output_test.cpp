// SPDX-License-Identifier: Apache-2.0
#include "telemime/outputs/file_output.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <regex>
#include <string>

#include "telemime/core/files.h"
#include "telemime/core/scratch_folder.h"
#include "telemime/core/testing_errors.h"
#include "telemime/outputs/all.h"
#include "telemime/outputs/readers/jsonl.h"
#include "telemime/outputs/testing_bap.h"
#include "telemime/outputs/testing_bvh.h"
#include "telemime/outputs/testing_motion.h"

namespace telemime {
namespace {

class FileOutputTest : public testing::Test {
 protected:
  const StreamHeader header_ = testing_motion::header();
  const std::vector<MotionFrame> frames_ = testing_motion::gesture(header_, 10);
  const ScratchFolder scratch_;
  const std::filesystem::path folder_ = scratch_.path();
};

TEST_F(FileOutputTest, WritesWhatTheEncoderMakes) {
  for (const OutputFormat& format : kOutputFormats) {
    const auto path = folder_ / format.file_name;
    FileOutput output(path, format.make({}), header_);
    for (const MotionFrame& frame : frames_) {
      output.write(frame);
    }
    output.close();
    output.close();
    EXPECT_EQ(read_text_file(path), testing_motion::encode_all(*format.make({}), header_, frames_))
        << format.name;
  }
}

TEST_F(FileOutputTest, AFileIsValidAfterEveryFrame) {
  FileOutput json(folder_ / "pose.jsonl", make_jsonl_encoder(), header_);
  FileOutput bvh(folder_ / "motion.bvh", make_bvh_encoder(), header_);
  FileOutput bap(folder_ / "motion.bap", make_bap_encoder("iso"), header_);
  for (std::size_t f = 0; f < frames_.size(); ++f) {
    json.write(frames_[f]);
    bvh.write(frames_[f]);
    bap.write(frames_[f]);
    // Nothing was closed: this is what a killed run leaves behind.
    const PoseFile json_file = read_pose_jsonl(json.path());
    const testing_bvh::BvhFile bvh_file = testing_bvh::parse_bvh(read_text_file(bvh.path()));
    const testing_bap::BapFile bap_file = testing_bap::parse_bap(read_text_file(bap.path()));
    EXPECT_EQ(json_file.frames.size(), f + 1);
    EXPECT_EQ(bvh_file.frames.size(), f + 1);
    EXPECT_EQ(bap_file.stated_frames, static_cast<std::int64_t>(f + 1));
    EXPECT_EQ(bap_file.frames.size(), f + 1);
    EXPECT_EQ(json_file.complaint, "");
  }
}

// Readers that others wrote take "Frames:        165" or "007" for something else.
TEST_F(FileOutputTest, NumbersInTextAreNotPadded) {
  std::vector<MotionFrame> frames = frames_;
  frames[4].state = TrackState::lost;
  StreamHeader header = header_;
  header.fingers = true;
  Random random(3);
  for (MotionFrame& frame : frames) {
    frame.hands = testing_motion::random_hands(header.body, frame.pose, random);
  }
  const std::regex padded(R"(([ \t] |: {2,}|^ +|, {2,})[-+.0-9]|(^|[^.0-9A-Za-z_])[-+]?0[0-9]|[+][0-9])",
                          std::regex::ECMAScript | std::regex::multiline);
  for (const OutputFormat& format : kOutputFormats) {
    const std::string text = testing_motion::encode_all(*format.make({}), header, frames);
    std::smatch found;
    if (!text.starts_with("glTF")) {
      EXPECT_FALSE(std::regex_search(text, found, padded)) << format.name << ": \"" << found.str() << '"';
    }
  }
}

TEST_F(FileOutputTest, AFullDiskIsNamed) {
  const std::string message =
      error_of(ErrorKind::output, [&] { FileOutput output("/dev/full", make_jsonl_encoder(), header_); });
  EXPECT_NE(message.find("/dev/full"), std::string::npos) << message;
  EXPECT_NE(message.find("No space left"), std::string::npos) << message;
}

TEST_F(FileOutputTest, AFolderThatIsNotThereIsNamed) {
  const std::string file = folder_ / "missing" / "pose.jsonl";
  const std::string message =
      error_of(ErrorKind::output, [&] { FileOutput output(file, make_jsonl_encoder(), header_); });
  EXPECT_NE(message.find(file), std::string::npos) << message;
  EXPECT_NE(message.find("No such file"), std::string::npos) << message;
}

TEST_F(FileOutputTest, AFrameThatDoesNotFitIsTakenBack) {
  const auto path = folder_ / "pose.jsonl";
  const auto whole = testing_motion::encode_all(*make_jsonl_encoder(), header_, {frames_[0], frames_[1]});
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);  // so that the write fails instead
  FileOutput output(path, make_jsonl_encoder(), header_);
  const rlimit small = {whole.size() + 100, before.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  output.write(frames_[0]);
  output.write(frames_[1]);
  const std::string message = error_of(ErrorKind::output, [&] { output.write(frames_[2]); });
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_NE(message.find("pose.jsonl"), std::string::npos) << message;
  EXPECT_EQ(read_text_file(path), whole);
}

TEST_F(FileOutputTest, APipeIsWrittenWithoutPatches) {
  const auto path = folder_ / "pipe";
  ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
  const int reader = ::open(path.c_str(), O_RDONLY | O_NONBLOCK);
  ASSERT_GE(reader, 0);
  FileOutput output(path, make_bap_encoder("iso"), header_);
  output.write(frames_[0]);
  output.close();
  std::string text(100000, '\0');
  const ssize_t size = ::read(reader, text.data(), text.size());
  ::close(reader);
  ASSERT_GT(size, 0);
  text.resize(static_cast<std::size_t>(size));
  const testing_bap::BapFile file = testing_bap::parse_bap(text);
  EXPECT_EQ(file.frames.size(), 1U);
  EXPECT_EQ(file.stated_frames, 0);
}

TEST(OutputFormats, AreFoundByName) {
  for (const OutputFormat& format : kOutputFormats) {
    EXPECT_EQ(&output_format(format.name), &format);
  }
  EXPECT_THROW(output_format("fbx"), Error);
}

}  // namespace
}  // namespace telemime
