// SPDX-License-Identifier: Apache-2.0
// The whole live program with a faulty network camera: the messages that a page receives.
#include <gtest/gtest.h>

#include <algorithm>

#include "live/mjpeg_server.h"
#include "live/page.h"
#include "live/scripted_source.h"
#include "telemime/capture/live.h"
#include "telemime/live/live_program.h"

namespace telemime {
namespace {

using live_testing::jpegs;
using live_testing::Json;
using live_testing::MjpegServer;
using live_testing::person;
using live_testing::receive;

std::vector<std::string> person_frames() {
  std::vector<cv::Mat> pictures;
  for (const Frame& frame : person()) {
    pictures.push_back(frame.image);
  }
  return jpegs(pictures);
}

class ProgramStream : public ::testing::Test {
 protected:
  ProgramStream() {
    camera_.show(person_frames(), kRate);
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
    expect_phase("tracking");
  }
  Json expect_phase(const std::string& phase) {
    return receive(*page_, "status", [&](const Json& j) { return j.at("phase") == phase; });
  }
  void expect_message(const std::string& level, const std::string& words) {
    expect_message(*page_, level, words);
  }
  void expect_message(SocketClient& page, const std::string& level, const std::string& words) {
    receive(page, "message", [&](const Json& j) {
      return j.at("level") == level && j.at("words").get<std::string>().find(words) != std::string::npos;
    });
  }
  bool warned_of(const std::string& words) const {
    const std::vector<std::string> all = program_->report().state.warnings;
    return std::any_of(all.begin(), all.end(),
                       [&](const std::string& one) { return one.find(words) != std::string::npos; });
  }
  void expect_state(const std::string& state) {
    receive(*page_, "pose", [&](const Json& j) { return j.at("state") == state; });
  }

  static constexpr double kRate = 25.0;
  ScratchFolder folder_;
  MjpegServer camera_;
  std::unique_ptr<LiveProgram> program_;
  std::unique_ptr<SocketClient> page_;
};

TEST_F(ProgramStream, CameraGoesAndReturns) {
  camera_.unplug();
  expect_message("warning", "stopped");
  expect_state("lost");
  EXPECT_NE(expect_phase("stopped").at("words"), "");
  camera_.plug_in();
  expect_message("info", "is back");
  expect_phase("tracking");
  expect_state("tracking");
}

TEST_F(ProgramStream, FiveFramesPerSecond) {
  camera_.show(person_frames(), 5.0);
  expect_message("warning", "only 5 frames per second");
  for (int i = 0; i < 3; ++i) {
    expect_state("tracking");
  }
  SocketClient late(program_->port());
  expect_message(late, "warning", "only 5 frames per second");  // it still applies
  EXPECT_TRUE(warned_of("frames per second"));
  camera_.show(person_frames(), kRate);
  expect_message("info", "again");
  EXPECT_FALSE(warned_of("frames per second"));
}

TEST_F(ProgramStream, EndsWhileCameraIsGone) {
  camera_.unplug();
  expect_phase("stopped");
  program_.reset();
}

}  // namespace
}  // namespace telemime
