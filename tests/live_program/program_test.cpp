// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <future>
#include <mutex>

#include "live/page.h"
#include "live/scripted_source.h"
#include "telemime/core/errors.h"
#include "telemime/live/live_program.h"
#include "telemime/streaming/testing_receivers.h"

namespace telemime {
namespace {

using live_testing::camera_of;
using live_testing::empty_room;
using live_testing::Json;
using live_testing::person_scene;
using live_testing::quick_request;
using live_testing::receive;
using live_testing::ScriptedScene;

class LiveRun : public ::testing::Test {
 protected:
  LiveRequest options() const {
    LiveRequest options;
    options.request = quick_request(folder_);
    options.web.port = 0;
    options.recordings = folder_.file("recordings");
    options.settings = folder_.path() / "config" / "live.json";
    return options;
  }
  LiveProgram::Message console() {
    return [this](MessageLevel level, const std::string& words) {
      const std::lock_guard lock(mutex_);
      (level == MessageLevel::error     ? errors_
       : level == MessageLevel::warning ? warnings_
                                        : infos_) += words + "\n";
    };
  }
  bool contains(const std::string& text, const std::string& words) {
    const std::lock_guard lock(mutex_);
    return text.find(words) != std::string::npos;
  }
  // Waits until the program has processed this number of further frames.
  static void process_frames(const LiveProgram& program, std::int64_t frames) {
    const std::int64_t before = program.report().state.rates.frames;
    ASSERT_TRUE(comes_true([&] { return program.report().state.rates.frames >= before + frames; }));
  }

  std::shared_ptr<ScriptedScene> scene_ = person_scene();
  ScratchFolder folder_;
  std::mutex mutex_;
  std::string infos_;
  std::string warnings_;
  std::string errors_;
};

TEST_F(LiveRun, ComputesNothingWithoutViewers) {
  const LiveProgram program(options(), camera_of(scene_), {});
  process_frames(program, 30);
  EXPECT_EQ(program.report().pictures, 0);
  EXPECT_EQ(program.report().poses, 0);
  {
    SocketClient page(program.port());
    receive(page, "pose");
    EXPECT_TRUE(comes_true([&] { return program.report().pictures > 0; }));
    page.say(R"({"type":"pictures","on":false})");
    page.say(R"({"type":"ping","id":1})");
    receive(page, "pong");
    const LiveReport hidden = program.report();
    process_frames(program, 30);
    EXPECT_LE(program.report().pictures, hidden.pictures + 2) << "except for those on their way";
    EXPECT_GT(program.report().poses, hidden.poses + 10) << "poses are still sent";
    page.say(R"({"type":"poses","on":false})");
    page.say(R"({"type":"ping","id":2})");
    receive(page, "pong");
    const LiveReport asleep = program.report();
    process_frames(program, 30);
    EXPECT_LE(program.report().poses, asleep.poses + 2);
    page.say(R"({"type":"poses","on":true})");
    receive(page, "pose");
  }
  ASSERT_TRUE(comes_true([&] { return program.report().pages == 0; }));
  const LiveReport alone = program.report();
  process_frames(program, 30);
  EXPECT_LE(program.report().poses, alone.poses + 2);
}

// A camera that takes its time to say what it is.
class SlowCamera final : public Source {
 public:
  SlowCamera(std::unique_ptr<Source> camera, std::shared_future<void> ready)
      : camera_(std::move(camera)), ready_(std::move(ready)) {}
  const SourceInfo& info() const override {
    ready_.wait();
    return camera_->info();
  }
  std::optional<Frame> next() override { return camera_->next(); }
  void stop() override { camera_->stop(); }
  std::string complaint() const override { return camera_->complaint(); }

 private:
  std::unique_ptr<Source> camera_;
  std::shared_future<void> ready_;
};

TEST_F(LiveRun, EarlyPageGetsStatusThenHello) {
  LiveRequest request = options();
  request.web.port = testing_receivers::free_port();
  std::promise<void> ready;
  auto camera = std::make_unique<SlowCamera>(camera_of(scene_), ready.get_future().share());
  auto program = std::async(std::launch::async, [&] {
    return std::make_unique<LiveProgram>(request, std::move(camera), LiveProgram::Message());
  });
  std::unique_ptr<SocketClient> page = live_testing::connect_when_ready(request.web.port);
  ASSERT_TRUE(page);
  const Json first = Json::parse(page->heard());
  EXPECT_EQ(first.at("type"), "status");
  EXPECT_EQ(first.at("phase"), "opening");
  EXPECT_NE(first.at("words"), "");
  page->say(R"({"type":"ping","id":3})");
  EXPECT_EQ(receive(*page, "pong").at("id"), 3) << "the page can tell that the program is alive";
  page->say(R"({"type":"recalibrate"})");
  EXPECT_EQ(receive(*page, "message").at("level"), "error");
  page->say(R"({"type":"output","add":"vmc://localhost"})");
  EXPECT_EQ(receive(*page, "status", [](const Json& j) { return !j.at("outputs").empty(); }).at("phase"),
            "opening");
  ready.set_value();
  receive(*page, "hello");
  receive(*page, "status", [](const Json& j) { return j.at("phase") == "tracking"; });
  program.get();
}

TEST_F(LiveRun, NextRunListsAndResumesOutputs) {
  testing_receivers::UdpReceiver receiver;
  const std::string url = "vmc://127.0.0.1:" + std::to_string(receiver.port());
  const std::string add = Json{{"type", "output"}, {"add", url}}.dump();
  const auto is = [&](const std::string& state) {
    return [url, state](const Json& j) {
      return j.at("outputs").size() == 1 && j.at("outputs").at(0).at("url") == url &&
             j.at("outputs").at(0).at("state") == state;
    };
  };
  {
    const LiveProgram program(options(), camera_of(scene_), console());
    SocketClient page(program.port());
    page.say(add);
    receive(page, "status", is("sending"));
  }
  scene_ = person_scene();
  while (receiver.receive(0)) {
  }
  {
    const LiveProgram program(options(), camera_of(scene_), console());
    EXPECT_TRUE(contains(infos_, url)) << infos_;
    SocketClient page(program.port());
    receive(page, "status", is("off"));
    process_frames(program, 30);
    EXPECT_FALSE(receiver.receive(0)) << "it was not requested in this run";
    page.say(add);
    receive(page, "status", is("sending"));
    EXPECT_TRUE(receiver.receive());
    page.say(Json{{"type", "output"}, {"off", url}}.dump());
    receive(page, "status", is("off"));
  }
  scene_ = person_scene();
  while (receiver.receive(0)) {
  }
  LiveRequest resumed = options();
  resumed.resume_outputs = true;
  const LiveProgram program(resumed, camera_of(scene_), console());
  EXPECT_TRUE(receiver.receive());
  SocketClient page(program.port());
  page.say(Json{{"type", "output"}, {"remove", url}}.dump());
  receive(page, "status", [](const Json& j) { return j.at("outputs").empty(); });
  EXPECT_EQ(warnings_ + errors_, "");
}

TEST_F(LiveRun, PermanentCameraFailureHasAMessage) {
  const LiveProgram program(options(), camera_of(scene_), console());
  SocketClient page(program.port());
  receive(page, "pose");
  EXPECT_FALSE(program.report().failure);
  scene_->end();
  EXPECT_EQ(live_testing::receive_error(page), "the cable is out");
  ASSERT_TRUE(program.report().failure);
  EXPECT_TRUE(program.report().failure->input);
  EXPECT_EQ(program.report().failure->words, "the cable is out");
  EXPECT_TRUE(contains(errors_, "the cable is out"));
}

TEST_F(LiveRun, EndOfFileIsNoFailure) {
  LiveRequest request = options();
  request.request.input = "http://host/talk.mp4";
  request.ends = true;
  const LiveProgram program(request, camera_of(scene_), console());
  process_frames(program, 1);
  scene_->end();
  EXPECT_TRUE(comes_true([&] { return contains(warnings_, "the cable is out"); })) << "the fault is reported";
  EXPECT_EQ(program.report().state.phase, LivePhase::ended);
  EXPECT_FALSE(program.report().failure);
  const std::lock_guard lock(mutex_);
  EXPECT_EQ(errors_, "");
}

TEST_F(LiveRun, GuideWaitsForAPageAndReportsIt) {
  LiveRequest request = options();
  request.request.background.clear();
  request.page_wait = 2.0;
  scene_->show(empty_room());
  const LiveProgram program(request, camera_of(scene_), console());
  SocketClient avatar(program.port());  // a page that shows no camera does not guide
  avatar.say(R"({"type":"pictures","on":false})");
  const std::string url = "http://localhost:" + std::to_string(program.port());
  EXPECT_TRUE(comes_true([&] { return contains(warnings_, "waiting for the page"); }));
  EXPECT_TRUE(contains(warnings_, url) && contains(warnings_, "--no-guide")) << warnings_;
  EXPECT_FALSE(contains(warnings_, "continuing without"));
  EXPECT_TRUE(comes_true([&] { return contains(warnings_, "continuing without"); }));
  EXPECT_TRUE(comes_true([&] { return program.report().state.phase == LivePhase::person; }));
}

TEST(PageUrl, IsReachableFromThisComputer) {
  WebServerOptions web;
  EXPECT_EQ(page_url(web, 7070), "http://localhost:7070");
  web.address = "0.0.0.0";
  EXPECT_EQ(page_url(web, 1), "http://localhost:1");
  web.address = "192.168.1.5";
  EXPECT_EQ(page_url(web, 2), "http://192.168.1.5:2");
  web.address = "fd00::1";
  EXPECT_EQ(page_url(web, 3), "http://[fd00::1]:3");
}

}  // namespace
}  // namespace telemime
