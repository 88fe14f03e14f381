// SPDX-License-Identifier: Apache-2.0
// The whole live program with a camera in the network that has whims: what the page hears.
#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "live/mjpeg_server.h"
#include "live/page.h"
#include "live/scripted_source.h"
#include "telemime/capture/live.h"
#include "telemime/live/live_program.h"

namespace telemime {
namespace {

using live_testing::hear;
using live_testing::jpegs;
using live_testing::Json;
using live_testing::MjpegServer;
using live_testing::person;

std::vector<std::string> somebody(cv::Size size = {}) {
  std::vector<cv::Mat> pictures;
  for (const Frame& frame : person()) {
    pictures.push_back(frame.image);
    if (!size.empty()) {
      cv::resize(frame.image, pictures.back(), size);
    }
  }
  return jpegs(pictures);
}

class ProgramStream : public ::testing::Test {
 protected:
  ProgramStream() {
    camera_.show(somebody(), kRate);
    LiveRequest request;
    request.request = live_testing::quick_request(folder_);
    request.web.port = 0;
    request.recordings = folder_.file("recordings");
    LiveOptions options;
    options.pauses = {0.05};
    options.longest_pause = 0.05;
    options.silence = 0.5;
    options.patience = 4.0;
    program_ =
        std::make_unique<LiveProgram>(request, open_source(camera_.url(), options), LiveProgram::Message());
    page_ = std::make_unique<SocketClient>(program_->port());
    hear_phase("tracking");
  }
  Json hear_phase(const std::string& phase) {
    return hear(*page_, "status", [&](const Json& j) { return j.at("phase") == phase; });
  }
  void hear_words(const std::string& level, const std::string& words) { hear_words(*page_, level, words); }
  void hear_words(SocketClient& page, const std::string& level, const std::string& words) {
    hear(page, "message", [&](const Json& j) {
      return j.at("level") == level && j.at("words").get<std::string>().find(words) != std::string::npos;
    });
  }
  bool warned_of(const std::string& words) const {
    const std::vector<std::string> all = program_->report().state.warnings;
    return std::any_of(all.begin(), all.end(),
                       [&](const std::string& one) { return one.find(words) != std::string::npos; });
  }
  void hear_state(const std::string& state) {
    hear(*page_, "pose", [&](const Json& j) { return j.at("state") == state; });
  }

  static constexpr double kRate = 25.0;
  ScratchFolder folder_;
  MjpegServer camera_;
  std::unique_ptr<LiveProgram> program_;
  std::unique_ptr<SocketClient> page_;
};

TEST_F(ProgramStream, ACameraThatGoesAndComesBack) {
  camera_.unplug();
  hear_words("warning", "stopped");
  hear_state("lost");
  EXPECT_NE(hear_phase("stopped").at("words"), "");
  camera_.plug_in();
  hear_words("info", "is back");
  hear_phase("tracking");
  hear_state("tracking");
}

TEST_F(ProgramStream, ACameraThatFallsSilent) {
  camera_.fall_silent();
  hear_words("warning", "no pictures");
  hear_phase("stopped");
  camera_.show(somebody(), kRate);
  hear_words("info", "is back");
  hear_state("tracking");
}

TEST_F(ProgramStream, AnotherPictureSize) {
  camera_.show(somebody({640, 480}), kRate);
  hear_words("warning", "640x480");
  for (int i = 0; i < 5; ++i) {
    hear_state("tracking");
  }
  EXPECT_NE(program_->report().state.phase, LivePhase::ended);
}

TEST_F(ProgramStream, FivePicturesASecond) {
  camera_.show(somebody(), 5.0);
  hear_words("warning", "only 5 pictures a second");
  for (int i = 0; i < 3; ++i) {
    hear_state("tracking");
  }
  SocketClient late(program_->port());
  hear_words(late, "warning", "only 5 pictures a second");  // it is still so
  EXPECT_TRUE(warned_of("pictures a second"));
  camera_.show(somebody(), kRate);
  hear_words("info", "again");
  EXPECT_FALSE(warned_of("pictures a second"));
}

TEST_F(ProgramStream, Garbage) {
  auto parts = somebody();
  parts[1] = std::string(5000, 'x');
  parts[3].resize(parts[3].size() / 2);
  camera_.show(parts, kRate);
  hear_words("warning", "damaged");
  hear_state("tracking");
  camera_.show(somebody(), kRate);
  hear_words("info", "whole again");
}

TEST_F(ProgramStream, EndsWhileTheCameraIsGone) {
  camera_.unplug();
  hear_phase("stopped");
  program_.reset();
}

}  // namespace
}  // namespace telemime
