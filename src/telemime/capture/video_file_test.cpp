// SPDX-License-Identifier: Apache-2.0
#include "telemime/capture/video_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cctype>
#include <cstdlib>
#include <opencv2/imgcodecs.hpp>

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

TEST_F(VideoFileTest, AnyNameOfAFileIsThatFile) {
  std::filesystem::create_directories(scratch_.file("http:/x"));
  for (const char* name :
       {"take:2.avi", "a%d.avi", "b[1]*.avi", "concat:c|d.avi", "12345", "http:/x/e.avi"}) {
    testing::write_clip(scratch_.file("clip.avi"), 3);
    std::filesystem::rename(scratch_.file("clip.avi"), scratch_.file(name));
    EXPECT_EQ(open_source(scratch_.file(name))->info().frames, 3) << name;
    const std::filesystem::path here = std::filesystem::current_path();
    std::filesystem::current_path(scratch_.file(""));
    EXPECT_EQ(open_source(std::string("./") + name)->info().frames, 3) << name;
    if (std::string(name) == "12345") {
      EXPECT_NE(refusal(name).find("./12345"), std::string::npos);
    } else {
      EXPECT_EQ(open_source(name)->info().frames, 3) << name;
    }
    std::filesystem::current_path(here);
  }
}

TEST_F(VideoFileTest, ARateThatIsGivenReplacesTheTimes) {
  testing::write_clip(scratch_.file("clip.avi"), 4);
  const std::unique_ptr<Source> source = open_source(scratch_.file("clip.avi"), {.rate = 240.0});
  EXPECT_EQ(source->info().fps, 240.0);
  source->next();
  EXPECT_DOUBLE_EQ(source->next()->time, 1.0 / 240.0);
}

TEST_F(VideoFileTest, MirroredPicturesAreMirroredBack) {
  cv::Mat image(48, 64, CV_8UC3, cv::Scalar::all(20));
  image.colRange(0, 32) = cv::Scalar::all(200);
  cv::imwrite(scratch_.file("a.png"), image);
  EXPECT_EQ(open_source(scratch_.file("a.png"), {.mirrored = true})->next()->image.at<cv::Vec3b>(9, 9)[0],
            20);
}

// What files of other programs state, made by FFmpeg; their frames are those of the demo clip.
struct Odd {
  const char* name;
  const char* options;
  double fps;
  double seconds;  ///< from the first to the last frame
  int width;
  const char* words;  ///< of the complaint; null: there is none
};

class OddVideoTest : public VideoFileTest, public ::testing::WithParamInterface<Odd> {};

TEST_P(OddVideoTest, TimesAndPixelsAreTheTrueOnes) {
  const Odd& odd = GetParam();
  const std::string file = scratch_.file(odd.name);
  const std::string command = "ffmpeg -v error -f lavfi -i testsrc=s=96x64:r=25:d=4 -c:v mpeg4 " +
                              std::string(odd.options) + " 'file:" + file + "'";
  if (std::system("ffmpeg -version > /dev/null 2>&1") != 0) {
    GTEST_SKIP() << "FFmpeg is not installed";
  }
  ASSERT_EQ(std::system(command.c_str()), 0) << command;
  const std::unique_ptr<Source> source = open_source(file);
  EXPECT_NEAR(source->info().fps, odd.fps, 1e-3);
  EXPECT_EQ(source->info().width, odd.width);
  double last = -1.0;
  while (const std::optional<Frame> frame = source->next()) {
    EXPECT_GT(frame->time, last);
    EXPECT_EQ(frame->image.cols, odd.width);
    last = frame->time;
  }
  EXPECT_NEAR(last, odd.seconds, 0.045);
  EXPECT_EQ(source->complaint().empty(), odd.words == nullptr) << source->complaint();
  EXPECT_NE(source->complaint().find(odd.words == nullptr ? "" : odd.words), std::string::npos)
      << source->complaint();
}

INSTANTIATE_TEST_SUITE_P(
    Files, OddVideoTest,
    ::testing::Values(
        Odd{"plain.mp4", "", 25.0, 3.96, 96, nullptr},
        Odd{"pause.mp4", "-vf 'setpts=PTS+gte(N\\,50)*15/TB' -vsync vfr", 25.0, 18.96, 96, "time stamps"},
        Odd{"missing.mkv", "-vf 'select=not(eq(mod(n\\,4)\\,1))' -vsync vfr", 25.0, 3.96, 96, nullptr},
        Odd{"slow.mkv", "-vf setpts=2*PTS -vsync vfr", 12.5, 7.92, 96, "time stamps"},
        Odd{"raw.m4v", "", 25.0, 3.96, 96, nullptr},
        Odd{"wide.mkv", "-vf setsar=4/3", 25.0, 3.96, 128, nullptr},
        Odd{"narrow.mp4", "-vf setsar=8/9", 25.0, 3.96, 96, nullptr},
        Odd{"take:2 of 3%d.mp4", "", 25.0, 3.96, 96, nullptr}),
    [](const auto& test) {
      std::string name = test.param.name;
      std::erase_if(name, [](unsigned char c) { return std::isalnum(c) == 0; });
      return name;
    });

// Odd inputs out of bug reports of comparable tools.
TEST_F(VideoFileTest, OddInputsInTheTestDataAreTrue) {
  const char* const data = std::getenv("TELEMIME_DATA");
  const std::filesystem::path folder = std::filesystem::path(data == nullptr ? "" : data) / "trials";
  if (!std::filesystem::exists(folder)) {
    GTEST_SKIP() << "no odd inputs: TELEMIME_DATA names no folder with trials";
  }
  struct Right {
    const char* name;
    double fps;
    double seconds;
    int width;
    const char* words;
  };
  for (const Right& right :
       {Right{"mediarecorder_jitter.webm", 25.0, 6.59, 320, "time stamps"},
        Right{"vfr.webm", 25.0, 6.56, 320, ""}, Right{"pause15s.mp4", 25.0, 21.56, 320, "time stamps"},
        Right{"phone_119881.mp4", 119.881, 1.368, 320, ""},
        Right{"anamorphic_sar4_3.mp4", 25.0, 6.56, 640, ""},
        Right{"sequence_gaps", 25.0, 59.0 / 25.0, 320, "10 to 12, 30"},
        Right{"sequence_gaps/frame_%04d.png", 25.0, 59.0 / 25.0, 320, "frame_0040.png"}}) {
    const auto source = open_source((folder / right.name).string());
    EXPECT_NEAR(source->info().fps, right.fps, 1e-3) << right.name;
    EXPECT_EQ(source->info().width, right.width) << right.name;
    double last = 0.0;
    while (const std::optional<Frame> frame = source->next()) {
      last = frame->time;
    }
    EXPECT_NEAR(last, right.seconds, 0.011) << right.name;
    EXPECT_EQ(source->complaint().empty(), std::string(right.words).empty()) << source->complaint();
    EXPECT_NE(source->complaint().find(right.words), std::string::npos) << source->complaint();
  }
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
