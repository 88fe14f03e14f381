// SPDX-License-Identifier: Apache-2.0
// `track` with several files.
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <thread>

#include "cli/exit_codes.h"
#include "run_program.h"
#include "telemime/outputs/readers/jsonl.h"

namespace telemime::e2e {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> command(const std::vector<std::string>& inputs, const std::string& out,
                                 const std::vector<std::string>& more = {}) {
  return joined({{"track"},
                 inputs,
                 {"--background", wall_clip(), "--no-overlay", "--out", out, "--particles", "300"},
                 quickly(),
                 more});
}

std::size_t frames_in(const std::string& folder) {
  return fs::exists(folder + "/pose.jsonl") ? read_pose_jsonl(folder + "/pose.jsonl").frames.size() : 0;
}

bool says(const Ended& ended, const std::string& words) {
  return ended.output.find(words) != std::string::npos || ended.words.find(words) != std::string::npos;
}

TEST(ManyFiles, EachHasAFolderAndOneThatFailsStopsNone) {
  const Folder folder;
  fs::create_directory(folder / "one");
  fs::create_directory(folder / "other");
  fs::create_directory_symlink(person_clip(), folder / "one/first");
  fs::create_directory_symlink(person_clip(), folder / "other/first");
  write_bytes(folder / "broken.mp4", "no video");
  const std::vector<std::string> inputs = {folder / "one/first", folder / "broken.mp4",
                                           folder / "other/first/"};
  const Ended ended = run(command(inputs, folder / "out", {"--jobs", "2"}));
  EXPECT_EQ(ended.code, kExitInput) << ended.words;
  EXPECT_EQ(frames_in(folder / "out/one-first"), std::size_t{kPersonFrames});
  EXPECT_EQ(frames_in(folder / "out/other-first"), std::size_t{kPersonFrames});
  EXPECT_TRUE(says(ended, "broken.mp4: failed")) << ended.output;
  EXPECT_TRUE(says(ended, "2 tracked, 0 done before, 1 failed")) << ended.output;

  // Again: only what failed. With another seed: all.
  const Ended again = run(command(inputs, folder / "out"));
  EXPECT_EQ(again.code, kExitInput);
  EXPECT_TRUE(says(again, "0 tracked, 2 done before, 1 failed")) << again.output;
  const Ended other = run(command({inputs[0], inputs[2]}, folder / "out", {"--seed", "7"}));
  EXPECT_EQ(other.code, 0);
  EXPECT_TRUE(says(other, "2 tracked, 0 done before, 0 failed")) << other.output;
}

TEST(ManyFiles, FoldersHaveNamesWithoutSecrets) {
  const Folder folder;
  fs::create_directory_symlink(person_clip(), folder / "first");
  const Ended ended =
      run(command({"http://127.0.0.1:9/clip.mp4?key=a.secret", folder / "first/."}, folder / "out"));
  EXPECT_NE(ended.code, 0) << "nothing is served at that port";
  EXPECT_EQ(frames_in(folder / "out/first"), std::size_t{kPersonFrames});
  EXPECT_FALSE(says(ended, "secret")) << ended.words;
  for (const auto& entry : fs::recursive_directory_iterator(folder.path())) {
    EXPECT_EQ(entry.path().string().find("secret"), std::string::npos) << entry.path();
  }
}

TEST(ManyFiles, HaveTheResultsOfEachAlone) {
  const Folder folder;
  ASSERT_EQ(run(command({person_clip()}, folder / "alone")).code, 0);
  fs::create_directory_symlink(person_clip(), folder / "second");
  ASSERT_EQ(run(command({person_clip(), folder / "second"}, folder / "many")).code, 0);
  EXPECT_EQ(bytes_of(folder / "alone/motion.bvh"), bytes_of(folder / "many/second/motion.bvh"));
}

TEST(ManyFiles, StoppedKeepWhatTheyHaveAndGoOnLater) {
  const Folder folder;
  std::vector<std::string> inputs;
  for (const char* name : {"a", "b", "c", "d"}) {
    inputs.push_back(folder / name);
    fs::create_directory_symlink(person_clip(), inputs.back());
  }
  Program program(command(inputs, folder / "out"));
  while (program.running() && frames_in(folder / "out/a") == 0) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  program.signal(SIGINT);
  const Ended stopped = program.wait();
  EXPECT_EQ(stopped.code, kExitInterrupted) << stopped.words;
  EXPECT_TRUE(says(stopped, "not begun")) << stopped.output;
  EXPECT_TRUE(says(stopped, " 0 failed")) << stopped.output;
  const Ended rest = run(command(inputs, folder / "out"));
  EXPECT_EQ(rest.code, 0) << rest.words;
  for (const char* name : {"out/a", "out/b", "out/c", "out/d"}) {
    EXPECT_EQ(frames_in(folder / name), std::size_t{kPersonFrames}) << name;
  }
}

// Whoever wants to read of errors only reads of this one.
TEST(ManyFiles, OneThatIsKilledIsNamed) {
  const Folder folder;
  for (const char* name : {"a", "b"}) {
    fs::create_directory_symlink(person_clip(), folder / name);
  }
  Program program(command({folder / "a", folder / "b"}, folder / "out", {"--quiet"}));
  const std::string main = std::to_string(program.process());
  pid_t child = 0;
  while (program.running() && child == 0) {
    std::ifstream("/proc/" + main + "/task/" + main + "/children") >> child;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  ASSERT_NE(child, 0);
  ::kill(child, SIGKILL);
  const Ended ended = program.wait();
  EXPECT_NE(ended.code, 0);
  EXPECT_TRUE(says(ended, "/a: ended by signal 9")) << ended.words;
}

TEST(ManyFiles, OneWithJobsHasItsFolder) {
  const Folder folder;
  fs::create_directory_symlink(person_clip(), folder / "only");
  ASSERT_EQ(run(command({folder / "only"}, folder / "out", {"--jobs", "3"})).code, 0);
  EXPECT_EQ(frames_in(folder / "out/only"), std::size_t{kPersonFrames});
}

TEST(ManyFiles, CannotBeShown) {
  const Folder folder;
  const Ended ended = run(command({person_clip(), wall_clip()}, folder / "out", {"--show"}));
  EXPECT_EQ(ended.code, kExitUsage);
  EXPECT_TRUE(says(ended, "--show is for one file"));
}

// A shell starts a process and then becomes the program, whose child that is from then on.
TEST(ManyFiles, InheritedProcessThatEndsIsNoneOfThem) {
  const Folder folder;
  fs::create_directory_symlink(person_clip(), folder / "one");
  fs::create_directory_symlink(person_clip(), folder / "two");
  const std::vector<std::string> inputs = {folder / "one", folder / "two"};
  const std::string track = shell_command(command(inputs, folder / "out", {"--quiet"}));
  EXPECT_EQ(std::system(("sleep 0.1 & exec " + track).c_str()), 0);
  for (const std::string& input : inputs) {
    EXPECT_EQ(frames_in(folder / "out/" + fs::path(input).filename().string()), std::size_t{kPersonFrames});
  }
}

}  // namespace
}  // namespace telemime::e2e
