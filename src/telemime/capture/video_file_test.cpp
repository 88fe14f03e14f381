// SPDX-License-Identifier: Apache-2.0
#include "telemime/capture/video_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "telemime/capture/prepare_opencv.h"
#include "telemime/capture/testing.h"
#include "telemime/core/testing_errors.h"

namespace telemime {
namespace {

class VideoFileTest : public ::testing::Test {
 protected:
  VideoFileTest() { prepare_opencv(); }

  /// The error message of opening the file.
  static std::string refusal(const std::string& input) {
    return error_of(ErrorKind::input, [&] { open_source(input); });
  }

  ScratchFolder scratch_;
};

TEST_F(VideoFileTest, ReturnsAllFramesWithTheirTimes) {
  testing::write_clip(scratch_.file("clip.avi"), 10);
  const std::unique_ptr<Source> source = open_source(scratch_.file("clip.avi"));
  EXPECT_EQ(source->info().width, 64);
  EXPECT_EQ(source->info().height, 48);
  EXPECT_EQ(source->info().frames, 10);
  EXPECT_DOUBLE_EQ(source->info().fps, 20.0);
  EXPECT_FALSE(source->info().live);
  std::vector<Frame> frames;
  while (std::optional<Frame> frame = source->next()) {
    frames.push_back(*frame);
  }
  ASSERT_EQ(frames.size(), 10U);
  for (int i = 0; i < 10; ++i) {  // after reading all: a frame must not change later
    EXPECT_EQ(frames[i].index, i);
    EXPECT_NEAR(frames[i].time, i / 20.0, 1e-6);
    EXPECT_EQ(testing::number_of(frames[i].image), i);
  }
  EXPECT_FALSE(source->next());
  EXPECT_EQ(source->complaint(), "");
}

TEST_F(VideoFileTest, DigitInNameIsNoImageNumber) {
  testing::write_clip(scratch_.file("clip1.avi"), 3);
  testing::write_clip(scratch_.file("clip2.avi"), 5);
  EXPECT_EQ(open_source(scratch_.file("clip1.avi"))->info().frames, 3);
}

TEST_F(VideoFileTest, TruncatedVideoGivesFramesAndComplaint) {
  const std::string clip = scratch_.file("cut.avi");
  testing::write_clip(clip, 40);
  testing::cut_to(clip, 0.5);
  const std::unique_ptr<Source> source = open_source(clip);
  int frames = 0;
  while (source->next()) {
    ++frames;
  }
  EXPECT_GT(frames, 10);
  EXPECT_LT(frames, 30);
  EXPECT_NE(source->complaint().find("after " + std::to_string(frames) + " frames"), std::string::npos)
      << source->complaint();
  EXPECT_NE(source->complaint().find("40"), std::string::npos) << source->complaint();
}

TEST_F(VideoFileTest, StatesTheCauseOfFailures) {
  EXPECT_NE(refusal(scratch_.file("absent.mp4")).find("no such file"), std::string::npos);

  testing::write_bytes(scratch_.file("empty.mp4"), "");
  EXPECT_NE(refusal(scratch_.file("empty.mp4")).find("empty"), std::string::npos);

  testing::write_bytes(scratch_.file("notes.mp4"), "Dear diary,\n\ttoday nothing moved.\n");
  EXPECT_NE(refusal(scratch_.file("notes.mp4")).find("text file"), std::string::npos);

  testing::write_bytes(scratch_.file("noise.mp4"), std::string(5000, '\x01'));
  EXPECT_NE(refusal(scratch_.file("noise.mp4")).find("not a video"), std::string::npos);

  testing::write_clip(scratch_.file("head.avi"), 20);
  testing::cut_to(scratch_.file("head.avi"), 0.03);
  EXPECT_NE(refusal(scratch_.file("head.avi")).find("cannot read"), std::string::npos);

  ASSERT_EQ(::mkfifo(scratch_.file("pipe.mp4").c_str(), 0600), 0);
  EXPECT_NE(refusal(scratch_.file("pipe.mp4")).find("not a plain file"), std::string::npos);
}

TEST_F(VideoFileTest, ReportsMissingPermissions) {
  const std::string clip = scratch_.file("secret.avi");
  testing::write_clip(clip, 2);
  ASSERT_EQ(::chmod(clip.c_str(), 0), 0);
  ASSERT_EQ(::chmod(scratch_.file("").c_str(), 0755), 0);
  constexpr uid_t nobody = 65534;
  const bool privileged = ::geteuid() == 0;  // root can read everything: become another user
  if (privileged) {
    ASSERT_EQ(::seteuid(nobody), 0);
  }
  const std::string message = refusal(clip);
  if (privileged) {
    ASSERT_EQ(::seteuid(0), 0);
  }
  EXPECT_NE(message.find("ermission denied"), std::string::npos) << message;
  EXPECT_NE(message.find("chmod"), std::string::npos) << message;
}

TEST_F(VideoFileTest, EmptyNameIsAUsageError) {
  EXPECT_NE(error_of(ErrorKind::usage, [] { open_source(""); }), "");
}

TEST_F(VideoFileTest, ReportsAMissingCamera) {
  EXPECT_NE(refusal("987").find("/dev/video987"), std::string::npos);
  EXPECT_NE(refusal("/dev/telemime_has_no_such_camera").find("there is no"), std::string::npos);
}

TEST_F(VideoFileTest, RefusesAnUnavailableStream) {
  // Port 9 of this computer ("discard") is closed where tests run, so the connection is refused at once.
  EXPECT_NE(refusal("http://127.0.0.1:9/clip.mjpeg").find("a stream"), std::string::npos);
}

}  // namespace
}  // namespace telemime
