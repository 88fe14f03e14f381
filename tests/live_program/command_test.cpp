// SPDX-License-Identifier: Apache-2.0
// `telemime live` as a user starts it: its messages, the page that it opens, its end.
#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "e2e/run_program.h"
#include "live/page.h"
#include "telemime/live/testing_settings.h"
#include "telemime/streaming/testing_receivers.h"
#include "telemime/streaming/testing_web_socket.h"

namespace telemime {
namespace {

using Words = std::vector<std::string>;

// Sets an environment variable for the scope.
class Variable {
 public:
  Variable(const char* name, const char* value) : name_(name) {
    if (const char* const old = std::getenv(name)) {
      old_ = old;
    }
    value == nullptr ? ::unsetenv(name) : ::setenv(name, value, 1);
  }
  ~Variable() { old_ ? ::setenv(name_, old_->c_str(), 1) : ::unsetenv(name_); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
  std::optional<std::string> old_;
};

class LiveCommand : public ::testing::Test {
 protected:
  // The arguments for the clip of a person in a loop, at any free port or the given one.
  Words live(const Words& more, std::uint16_t port = 0) const {
    Words all = {"live",   e2e::person_clip(),   "--background", e2e::wall_clip(),      "--loop",
                 "--port", std::to_string(port), "--recordings", folder_ / "recordings"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  // The arguments for an input that ends.
  Words once(const std::string& input, std::uint16_t port = 0) const {
    return {"live", input, "--port", std::to_string(port), "--recordings", folder_ / "recordings"};
  }
  // Waits for a program that should end by itself.
  static e2e::Ended end_of(e2e::Program& program) {
    EXPECT_TRUE(comes_true([&] { return !program.running(); }));
    if (program.running()) {
      program.signal(SIGKILL);
    }
    return program.wait();
  }
  static bool has(const std::string& text, const std::string& words) {
    return text.find(words) != std::string::npos;
  }

  e2e::Folder folder_;
  Variable config_{"XDG_CONFIG_HOME", folder_.path().c_str()};
  Variable display_{"DISPLAY", nullptr};
  Variable wayland_{"WAYLAND_DISPLAY", nullptr};
};

TEST_F(LiveCommand, ExitCodeIsZeroAtTimeoutAndInterrupt) {
  const e2e::Ended over = e2e::run(live({"--seconds", "1"}));
  EXPECT_EQ(over.code, 0) << over.words;
  EXPECT_TRUE(has(over.output, "Live page: http://localhost:")) << over.output;
  EXPECT_TRUE(has(over.output, "Processor load: ")) << over.output;

  const std::uint16_t port = testing_receivers::free_port();
  e2e::Program program(live({}, port));
  EXPECT_TRUE(comes_true([&] {
    const testing_receivers::Fd fd(::socket(AF_INET, SOCK_STREAM, 0));
    const sockaddr_in where = testing_receivers::loopback(port);
    return ::connect(fd.get(), reinterpret_cast<const sockaddr*>(&where), sizeof(where)) == 0;
  }));
  program.signal(SIGINT);
  EXPECT_EQ(program.wait().code, 0);
}

TEST_F(LiveCommand, EndsAfterFileIfNoPageIsOpen) {
  e2e::Program program(once(e2e::person_clip()));
  const e2e::Ended ended = end_of(program);
  EXPECT_EQ(ended.code, 0) << ended.words;
  EXPECT_TRUE(has(ended.words, "the input has ended")) << ended.words;
}

TEST_F(LiveCommand, StaysAfterFileWhilePageIsOpen) {
  const std::uint16_t port = testing_receivers::free_port();
  e2e::Program program(once(e2e::person_clip(), port));
  std::unique_ptr<SocketClient> page = live_testing::connect_when_ready(port);
  ASSERT_TRUE(page);
  for (int i = 0; i < 10; ++i) {  // for 5 s: longer than a page needs to reconnect
    live_testing::receive(*page, "status", [](const auto& status) { return status.at("phase") == "ended"; });
  }
  EXPECT_TRUE(program.running());
  page.reset();
  EXPECT_EQ(end_of(program).code, 0);
}

TEST_F(LiveCommand, ClipOnWebServerEndsDespiteErrors) {
  const std::string clip = folder_ / "clip.avi";
  e2e::write_grey_video(clip, 60, 90);
  std::filesystem::resize_file(clip, std::filesystem::file_size(clip) * 2 / 3);
  WebHandlers handlers;
  handlers.get = [&](const std::string&) {
    WebContent content;
    content.type = "video/x-msvideo";
    content.file = clip;
    return std::optional(content);
  };
  const WebServer server(any_port(), handlers);
  e2e::Program program(once("http://127.0.0.1:" + std::to_string(server.port()) + "/clip.avi"));
  const e2e::Ended ended = end_of(program);
  EXPECT_EQ(ended.code, 0) << ended.words;
  EXPECT_TRUE(has(ended.words, "its header states 60")) << ended.words;
}

TEST_F(LiveCommand, FailuresHaveExitCodes) {
  EXPECT_EQ(e2e::run({"live", "/nothing/here.mp4"}).code, 4);
  EXPECT_EQ(e2e::run(live({"--send", "vmc://"})).code, 2);
  EXPECT_EQ(e2e::run({"live", "--send", "vmc://127.0.0.1:39539", "/nothing/here.mp4"}).code, 4)
      << "one URL for each --send";
  EXPECT_EQ(e2e::run({"live", "--allow-host", "studio", "/nothing/here.mp4"}).code, 4);
  const WebServer other(any_port(), {});
  const e2e::Ended taken = e2e::run(live({"--quiet"}, other.port()));
  EXPECT_EQ(taken.code, 5);
  EXPECT_TRUE(has(taken.words, std::to_string(other.port()))) << "also with --quiet: " << taken.words;
}

TEST_F(LiveCommand, VirtualCameraGetsPictures) {
  const std::string camera = folder_ / "camera";
  e2e::write_bytes(camera, "");
  constexpr std::size_t kPicture = std::size_t{2} * 320 * 240;  // YUYV
  e2e::Program program(live({"--virtual-camera", camera}));
  EXPECT_TRUE(comes_true([&] { return std::filesystem::file_size(camera) >= 5 * kPicture; }));
  program.signal(SIGINT);
  const e2e::Ended ended = program.wait();
  EXPECT_EQ(ended.code, 0) << ended.words;
  EXPECT_EQ(std::filesystem::file_size(camera) % kPicture, 0U) << "whole pictures";

  const e2e::Ended none = e2e::run({"live", "/nothing/here.mp4", "--virtual-camera", "/dev/video63"});
  EXPECT_EQ(none.code, 5) << "before the input is opened";
  EXPECT_TRUE(has(none.words, "/dev/video63") && has(none.words, "v4l2loopback")) << none.words;
}

TEST_F(LiveCommand, QuietKeepsWarningsAndErrors) {
  save_settings(folder_.path() / "telemime" / "live.json", {"vmc://localhost:39539"});
  const e2e::Ended loud = e2e::run(live({"--seconds", "1"}));
  EXPECT_TRUE(has(loud.words, "outputs of earlier runs, off now: vmc://localhost:39539")) << loud.words;
  const e2e::Ended quiet = e2e::run(live({"--seconds", "1", "--quiet"}));
  EXPECT_EQ(quiet.words, "");
  const e2e::Ended unknown = e2e::run(live({"--seconds", "1", "--no-settings"}));
  EXPECT_FALSE(has(unknown.words, "vmc://")) << unknown.words;
  EXPECT_FALSE(has(unknown.output, "vmc://")) << unknown.output;
  e2e::write_bytes(folder_.path() / "telemime" / "live.json", "{{{");
  const e2e::Ended damaged = e2e::run(live({"--seconds", "1", "--quiet"}));
  EXPECT_EQ(damaged.code, 0);
  EXPECT_TRUE(has(damaged.words, "live.json")) << damaged.words;
}

TEST_F(LiveCommand, OpensThePageWithoutAShell) {
  const std::string note = folder_ / "note";
  e2e::write_bytes(folder_ / "xdg-open",
                   "#!/bin/sh\necho \"$# $1\" > " + note + ".part\nmv " + note + ".part " + note + "\n");
  std::filesystem::permissions(folder_ / "xdg-open", std::filesystem::perms::owner_all);
  const std::string path = folder_.path().string() + ":" + std::getenv("PATH");
  const Variable opener("PATH", path.c_str());
  const Variable display("DISPLAY", ":77");
  EXPECT_EQ(e2e::run(live({"--seconds", "1"})).code, 0);
  EXPECT_FALSE(std::filesystem::exists(note)) << "only with --open";

  const e2e::Ended ended = e2e::run(live({"--seconds", "1", "--open"}));
  EXPECT_EQ(ended.code, 0) << ended.words;
  ASSERT_TRUE(comes_true([&] { return std::filesystem::exists(note); }));
  const std::string start = "Live page: ";
  const std::size_t at = ended.output.find(start) + start.size();
  EXPECT_EQ(e2e::bytes_of(note), "1 " + ended.output.substr(at, ended.output.find(' ', at) - at) + "\n");
}

TEST_F(LiveCommand, ReportsRemedyIfPageCannotOpen) {
  const e2e::Ended blind = e2e::run(live({"--seconds", "1", "--open"}));
  EXPECT_EQ(blind.code, 0);
  EXPECT_TRUE(has(blind.words, "no display") && has(blind.words, "http://localhost:")) << blind.words;
  const Variable display("DISPLAY", ":77");
  const Variable path("PATH", folder_.path().c_str());
  const e2e::Ended bare = e2e::run(live({"--seconds", "1", "--open"}));
  EXPECT_EQ(bare.code, 0);
  EXPECT_TRUE(has(bare.words, "xdg-open") && has(bare.words, "http://localhost:")) << bare.words;
}

}  // namespace
}  // namespace telemime
