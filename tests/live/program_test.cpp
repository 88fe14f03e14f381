// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <vector>

#include "live/page.h"
#include "live/scripted_source.h"
#include "telemime/live/live_program.h"
#include "telemime/outputs/all.h"
#include "telemime/streaming/testing_web_socket.h"

namespace telemime {
namespace {

using live_testing::camera_of;
using live_testing::person;
using live_testing::person_scene;
using live_testing::quick_request;
using live_testing::receive;
using Json = nlohmann::json;

class Program : public ::testing::Test {
 protected:
  LiveRequest options() const {
    LiveRequest options;
    options.request = quick_request(folder_);
    options.avatars = folder_.path();
    options.web.port = 0;
    options.recordings = folder_.file("recordings");
    options.version = "1.2.3";
    return options;
  }
  std::unique_ptr<LiveProgram> start() const {
    return std::make_unique<LiveProgram>(options(), camera_of(person_scene()), LiveProgram::Message());
  }

  ScratchFolder folder_;
};

std::string get(std::uint16_t port, const std::string& path, int status) {
  RawClient client(port);
  client.send(request_text(port, path));
  const WebReply reply = client.reply();
  EXPECT_EQ(reply.status, status) << path;
  return reply.body;
}

TEST_F(Program, PageGetsPersonAndImages) {
  const auto program = start();
  SocketClient page(program->port());
  const Json hello = receive(page, "hello");
  EXPECT_EQ(hello.at("version"), "1.2.3");
  EXPECT_EQ(hello.at("camera").at("width"), person().front().image.cols);
  EXPECT_TRUE(receive(page, "body").at("bones").contains("leftHand"));
  const Json pose = receive(page, "pose", [](const Json& j) { return j.at("state") == "tracking"; });
  EXPECT_EQ(pose.at("bones").at("head").size(), 4U);
  EXPECT_EQ(pose.at("pixels").at("l_wrist").size(), 2U);
  // The rate is known after the second pose.
  receive(page, "status", [](const Json& j) {
    return j.at("phase") == "tracking" && j.at("fps").at("tracked").get<double>() > 0.0;
  });

  std::optional<SocketClient::Frame> image;
  while ((image = page.message()) && image->opcode != SocketClient::binary) {
  }
  ASSERT_TRUE(image);
  ASSERT_GT(image->payload.size(), 100U);
  EXPECT_EQ(image->payload.substr(0, 4), std::string("\x01\0\0\0", 4));
  EXPECT_EQ(image->payload.substr(16, 2), "\xFF\xD8") << "a JPEG";
}

TEST_F(Program, LatePageGetsTheBody) {
  const auto program = start();
  SocketClient first(program->port());
  receive(first, "pose");
  SocketClient later(program->port());
  EXPECT_EQ(Json::parse(later.heard()).at("type"), "hello");
  EXPECT_EQ(Json::parse(later.heard()).at("type"), "body");
  EXPECT_EQ(Json::parse(later.heard()).at("type"), "status");
}

TEST_F(Program, LatencyIsWhatPagesReport) {
  const auto program = start();
  SocketClient page(program->port());
  const Json pose = receive(page, "pose");
  page.say(Json{{"type", "drawn"}, {"frame", pose.at("frame")}, {"stamp", pose.at("stamp")}}.dump());
  const Json status = receive(page, "status", [](const Json& j) { return !j.at("latency").is_null(); });
  EXPECT_GT(status.at("latency").at("median").get<double>(), 0.0);
  EXPECT_TRUE(program->report().latency);
}

TEST_F(Program, RecordsAndServesTheFiles) {
  const auto program = start();
  SocketClient page(program->port());
  page.say(R"({"type":"record","on":true})");
  receive(page, "status",
          [](const Json& j) { return !j.at("recording").is_null() && j.at("recording").at("frames") > 10; });
  page.say(R"({"type":"record","on":false})");
  const Json status = receive(page, "status", [](const Json& j) { return !j.at("recordings").empty(); });
  const Json& recording = status.at("recordings").at(0);
  EXPECT_EQ(recording.at("number"), 1);
  ASSERT_EQ(recording.at("files").size(), kOutputFormats.size());
  for (const Json& file : recording.at("files")) {
    const std::string bytes =
        get(program->port(), "/recordings/1/" + file.at("name").get<std::string>(), 200);
    EXPECT_EQ(bytes.size(), file.at("bytes").get<std::size_t>()) << file.at("name");
    EXPECT_GT(bytes.size(), 100U);
  }
  EXPECT_EQ(ask(program->port(), "/recordings/1/motion.bvh", "Range: bytes=3-8\r\n").body, "RARCHY");
  get(program->port(), "/recordings/1/nothing.bvh", 404);
  get(program->port(), "/recordings/2/motion.bvh", 404);
  get(program->port(), "/recordings/1/../../live.json", 400);
  page.say(R"({"type":"forget","recording":1})");
  receive(page, "status", [](const Json& j) { return j.at("recordings").empty(); });
  get(program->port(), "/recordings/1/motion.bvh", 404);
}

TEST_F(Program, EachLookIsAnAvatar) {
  for (const std::string name : {"plain.vrm", "robot.vrm", "robot-light.vrm"}) {
    std::ofstream(folder_.file(name)) << "glTF " << name;
  }
  const auto program = start();
  SocketClient page(program->port());
  const Json hello = receive(page, "hello");
  EXPECT_EQ(hello.at("looks"), Json({"plain", "robot"}));
  for (const std::string name : {"plain.vrm", "robot.vrm", "robot-light.vrm"}) {
    EXPECT_EQ(get(program->port(), "/avatars/" + name, 200), "glTF " + name);
  }
  get(program->port(), "/avatars/nobody.vrm", 404);
}

// Frame numbers of the images between the next 60 poses, without those that were already on their way.
std::vector<std::uint32_t> next_images(SocketClient& page) {
  std::vector<std::uint32_t> frames;
  int poses = 0;
  for (int i = 0; poses < 60; ++i) {
    const auto message = page.message();
    if (!message) {
      ADD_FAILURE() << "the connection of the page was closed";
      break;
    }
    if (i > 10) {
      poses +=
          message->opcode == SocketClient::text && message->payload.find(R"("pose")") != std::string::npos;
      if (message->opcode == SocketClient::binary) {
        std::memcpy(&frames.emplace_back(), message->payload.data() + 4, 4);
      }
    }
  }
  return frames;
}

TEST_F(Program, PageGetsImagesInTheirOrder) {
  const auto program = start();
  SocketClient page(program->port());
  receive(page, "pose");
  const std::vector<std::uint32_t> frames = next_images(page);
  EXPECT_GT(frames.size(), 5U);
  EXPECT_TRUE(std::is_sorted(frames.begin(), frames.end())) << "none overtakes another";
}

}  // namespace
}  // namespace telemime
