// SPDX-License-Identifier: Apache-2.0
// What the program leaves behind: whole runs, runs that were stopped, places that cannot be written.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/mount.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "cli/exit_codes.h"
#include "run_program.h"
#include "telemime/outputs/readers/jsonl.h"
#include "telemime/outputs/testing_bap.h"
#include "telemime/outputs/testing_bvh.h"

namespace telemime::e2e {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> command(const std::string& input, const std::string& out) {
  return joined({{"track", input, "--background", wall_clip(), "--out", out, "--particles", "300"},
                 quickly(),
                 {"--no-overlay"}});
}

// The lines of a pose.jsonl without what depends on the clock.
std::vector<nlohmann::json> timeless(const std::string& file) {
  std::vector<nlohmann::json> lines;
  std::istringstream stream(bytes_of(file));
  for (std::string line; std::getline(stream, line);) {
    lines.push_back(nlohmann::json::parse(line));
    lines.back().erase("ms");
  }
  return lines;
}

// A full disk: a tiny file system, where that is allowed.
class TinyDisk {
 public:
  explicit TinyDisk(const Folder& folder) : path_(folder / "disk") {
    fs::create_directory(path_);
    mounted_ = ::mount("tmpfs", path_.c_str(), "tmpfs", 0, "size=16k") == 0;
  }
  ~TinyDisk() {
    if (mounted_) {
      ::umount2(path_.c_str(), MNT_DETACH);
    }
  }
  TinyDisk(const TinyDisk&) = delete;
  TinyDisk& operator=(const TinyDisk&) = delete;
  bool mounted() const { return mounted_; }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
  bool mounted_ = false;
};

TEST(Results, OfAPersonAreWholeAndReadable) {
  const Folder folder;
  const Ended done = run(command(person_clip(), folder / "out"));
  ASSERT_EQ(done.code, 0) << done.words;
  const PoseFile pose = read_pose_jsonl(folder / "out/pose.jsonl");
  ASSERT_EQ(pose.frames.size(), static_cast<std::size_t>(kPersonFrames));
  EXPECT_EQ(pose.complaint, "");
  EXPECT_EQ(pose.frames.back().state, TrackState::tracking);
  const auto report = nlohmann::json::parse(bytes_of(folder / "out/report.json"));
  EXPECT_EQ(report.at("frames"), kPersonFrames);
  EXPECT_GT(report.at("tracked").get<int>(), kPersonFrames / 2);
  EXPECT_FALSE(report.at("interrupted").get<bool>());
  for (const auto& file : report.at("files")) {
    EXPECT_TRUE(fs::exists(file.get<std::string>())) << file;
  }
  EXPECT_NE(done.output.find("10 frames"), std::string::npos) << done.output;
}

TEST(Results, AreTheSameForTheSameSeed) {
  const Folder folder;
  ASSERT_EQ(run(command(person_clip(), folder / "a")).code, 0);
  ASSERT_EQ(run(command(person_clip(), folder / "b")).code, 0);
  const auto a = timeless(folder / "a/pose.jsonl");
  ASSERT_EQ(a.size(), static_cast<std::size_t>(kPersonFrames) + 1);
  for (std::size_t i = 1; i < a.size(); ++i) {
    EXPECT_EQ(a[i].at("frame"), i - 1) << "every frame once, in order";
  }
  EXPECT_EQ(a, timeless(folder / "b/pose.jsonl"));
  EXPECT_EQ(bytes_of(folder / "a/motion.bvh"), bytes_of(folder / "b/motion.bvh"));
  auto other = command(person_clip(), folder / "c");
  other.insert(other.end(), {"--seed", "2"});
  ASSERT_EQ(run(other).code, 0);
  EXPECT_NE(bytes_of(folder / "a/motion.bvh"), bytes_of(folder / "c/motion.bvh")) << "the seed is used";
}

TEST(Results, OfARunThatWasStoppedAreValid) {
  for (const int number : {SIGINT, SIGTERM}) {
    const Folder folder;
    fs::create_directory(folder / "long");
    for (int i = 0; i < 2000; ++i) {  // the same pictures again and again: far more than it has time for
      const std::string from = person_clip() + "/frame_" + std::to_string(1000 + i % kPersonFrames) + ".png";
      fs::create_symlink(from, folder / "long/frame_" + std::to_string(10000 + i) + ".png");
    }
    auto arguments = command(folder / "long", folder / "out");
    arguments.insert(arguments.end(), {"--set", "calibration.look_ahead=12"});
    if (number == SIGTERM) {
      arguments.push_back("--no-offline");
    }
    Program program(arguments);
    const auto lines = [&] {
      const std::string bytes = bytes_of(folder / "out/pose.jsonl");
      return std::count(bytes.begin(), bytes.end(), '\n');
    };
    while (program.running() && lines() < 4) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    ASSERT_TRUE(program.running()) << program.wait().words;
    program.signal(number);
    const Ended stopped = program.wait();
    EXPECT_EQ(stopped.code, kExitInterrupted) << stopped.words;
    const PoseFile pose = read_pose_jsonl(folder / "out/pose.jsonl");
    EXPECT_EQ(pose.complaint, "");
    EXPECT_GE(pose.frames.size(), 3U);
    EXPECT_LT(pose.frames.size(), 2000U);
    EXPECT_EQ(testing_bvh::parse_bvh(bytes_of(folder / "out/motion.bvh")).frames.size(), pose.frames.size());
    EXPECT_EQ(testing_bap::parse_bap(bytes_of(folder / "out/motion.bap")).frames.size(), pose.frames.size());
    EXPECT_TRUE(nlohmann::json::parse(bytes_of(folder / "out/report.json")).at("interrupted").get<bool>());
  }
}

TEST(Results, ThatCannotBeWrittenAreNamed) {
  const Folder folder;
  write_bytes(folder / "file", "not a folder");
  const std::vector<std::string> places = {folder / "file", folder / "file/below", "/proc/telemime",
                                           "/dev/full"};
  for (const std::string& place : places) {
    const Ended refused = run(command(person_clip(), place));
    EXPECT_EQ(refused.code, kExitOutput) << place << ": " << refused.words;
    EXPECT_NE(refused.words.find(place), std::string::npos) << refused.words;
  }
  EXPECT_EQ(bytes_of(folder / "file"), "not a folder");
}

TEST(Results, FolderWithoutPermissionIsNamed) {
  if (::geteuid() == 0) {
    GTEST_SKIP() << "root may write everywhere";
  }
  const Folder folder;
  fs::create_directory(folder / "locked");
  fs::permissions(folder / "locked", fs::perms::owner_read | fs::perms::owner_exec);
  const Ended refused = run(command(person_clip(), folder / "locked"));
  EXPECT_EQ(refused.code, kExitOutput) << refused.words;
}

TEST(Results, CalibrationThatCouldNotBeWrittenIsRefusedBeforeTheInputIsRead) {
  const Folder folder;
  fs::create_directory(folder / "taken");
  for (const std::string& file : {folder / "missing/me.json", folder / "taken"}) {
    const Ended refused = run({"calibrate", folder / "no_such_input.mp4", "--out", file, "--quiet"});
    EXPECT_EQ(refused.code, kExitOutput) << refused.words;
    EXPECT_NE(refused.words.find(file), std::string::npos) << refused.words;
  }
}

// Ctrl-C in a terminal also ends what reads the output. `env` undoes what the runner of the tests may ignore.
TEST(Results, AreWholeWhenNobodyReadsTheOutput) {
  const Folder folder;
  const std::string track = shell_command(command(person_clip(), folder / "out"));
  write_bytes(folder / "script", "env --default-signal=PIPE " + track + " | true\nexit ${PIPESTATUS[0]}\n");
  EXPECT_EQ(std::system(("bash '" + folder / "script" + "'").c_str()), 0);
  EXPECT_EQ(read_pose_jsonl(folder / "out/pose.jsonl").frames.size(), std::size_t{kPersonFrames});
}

TEST(Results, FullDiskIsNamedAndWhatWasWrittenIsWhole) {
  const Folder folder;
  const TinyDisk disk(folder);
  if (!disk.mounted()) {
    GTEST_SKIP() << "mounting a small file system is not allowed here";
  }
  const Ended full = run(command(person_clip(), disk.path()));
  EXPECT_EQ(full.code, kExitOutput) << full.words;
  EXPECT_NE(full.words.find("No space left"), std::string::npos) << full.words;
  EXPECT_NE(full.words.find(disk.path()), std::string::npos) << full.words;
}

TEST(Results, OverlayVideoAndPictureAreMade) {
  const Folder folder;
  auto words = command(person_clip(), folder / "out");
  words.pop_back();  // --no-overlay
  ASSERT_EQ(run(words).code, 0);
  EXPECT_GT(fs::file_size(folder / "out/overlay.mp4"), 1000U);
  EXPECT_GT(fs::file_size(folder / "out/overlay.png"), 1000U);
}

TEST(Results, ASideResultThatFailsEndsNothing) {
  const Folder folder;
  const std::string out = folder / "2026-11-25T10:30:45+00:00";
  fs::create_directories(out + "/overlay.mp4");
  for (const char* display : {"DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM"}) {
    ::unsetenv(display);
  }
  auto words = command(person_clip(), out);
  words.back() = "--show";  // in place of --no-overlay
  const Ended ended = run(words);
  EXPECT_EQ(ended.code, 0) << ended.words;
  EXPECT_NE(ended.words.find("no window can be opened"), std::string::npos) << ended.words;
  EXPECT_NE(ended.words.find("the overlay video"), std::string::npos) << ended.words;
  const std::string poses = bytes_of(out + "/pose.jsonl");
  EXPECT_EQ(std::count(poses.begin(), poses.end(), '\n'), kPersonFrames + 1);
}

TEST(Results, OnlyTheFormatsThatWereAskedFor) {
  const Folder folder;
  auto words = command(person_clip(), folder / "out");
  words.insert(words.end(), {"--formats", "csv,bvh", "--frames", "3"});
  ASSERT_EQ(run(words).code, 0);
  EXPECT_TRUE(fs::exists(folder / "out/pose.csv"));
  EXPECT_TRUE(fs::exists(folder / "out/motion.bvh"));
  EXPECT_FALSE(fs::exists(folder / "out/pose.jsonl"));
  EXPECT_FALSE(fs::exists(folder / "out/motion.bap"));
}

TEST(Results, OfUnknownFormatsAreRefusedBeforeAnythingIsMade) {
  const Folder folder;
  for (const std::vector<std::string>& choice :
       {std::vector<std::string>{"--formats", "gif"}, {"--formats", "csv,gif"}, {"--bap-profile", "gif"}}) {
    auto words = command(person_clip(), folder / "out");
    words.insert(words.end(), choice.begin(), choice.end());
    const Ended refused = run(words);
    EXPECT_EQ(refused.code, kExitUsage) << choice[0] << ": " << refused.words;
    EXPECT_NE(refused.words.find("gif"), std::string::npos) << refused.words;
    EXPECT_FALSE(fs::exists(folder / "out"));
  }
}

}  // namespace
}  // namespace telemime::e2e
