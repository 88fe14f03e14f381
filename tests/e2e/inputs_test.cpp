// SPDX-License-Identifier: Apache-2.0
// What the program says to inputs and options that it cannot use.
#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "cli/exit_codes.h"
#include "run_program.h"

namespace telemime::e2e {
namespace {

namespace fs = std::filesystem;

::testing::AssertionResult fails_with(const Ended& run, int code, const std::vector<std::string>& causes) {
  if (run.code != code) {
    return ::testing::AssertionFailure()
           << "exit code " << run.code << " instead of " << code << ": " << run.words;
  }
  for (const std::string& cause : causes) {
    if (run.words.find(cause) == std::string::npos) {
      return ::testing::AssertionFailure() << "'" << cause << "' is missing in: " << run.words;
    }
  }
  if (run.words.find("unexpected failure") != std::string::npos) {
    return ::testing::AssertionFailure() << run.words;
  }
  return ::testing::AssertionSuccess();
}

Ended track(const std::string& input, const Folder& folder, std::vector<std::string> more = {}) {
  more.insert(more.begin(), {"track", input, "--out", folder / "out", "--set", "image.width=160", "--set",
                             "image.height=120", "--set", "registration.iterations=100"});
  return run(more);
}

TEST(Program, TellsItsVersionAndHelp) {
  EXPECT_EQ(run({"--version"}).code, 0);
  EXPECT_NE(run({"track", "--help"}).output.find("--background"), std::string::npos);
  EXPECT_EQ(run({"track", "--help"}).code, 0);
}

TEST(Program, RefusesUnknownWords) {
  const Folder folder;
  EXPECT_TRUE(fails_with(run({}), kExitUsage, {}));
  EXPECT_TRUE(fails_with(run({"dance"}), kExitUsage, {"--help"}));
  EXPECT_TRUE(fails_with(run({"track"}), kExitUsage, {"INPUT"}));
  EXPECT_TRUE(fails_with(track(person_clip(), folder, {"--frobnicate"}), kExitUsage, {"--frobnicate"}));
  EXPECT_TRUE(
      fails_with(track(person_clip(), folder, {"--method", "guess"}), kExitUsage, {"guess", "two-step"}));
  EXPECT_TRUE(fails_with(track(person_clip(), folder, {"--seed", "many"}), kExitUsage, {"seed"}));
  const std::pair<const char*, const char*> settings[] = {
      {"image.width", "NAME=VALUE"},
      {"=", "no setting ''"},
      {"image.width=wide", "'image.width' cannot be \"wide\""},
      {"image.width=3", "40 to 1920"},
      {"image.widht=160", "'image.width'"}};
  for (const auto& [setting, words] : settings) {
    EXPECT_TRUE(fails_with(run({"track", person_clip(), "--out", folder / "out", "--set", setting}),
                           kExitUsage, {words}));
  }
  EXPECT_FALSE(fs::exists(folder / "out")) << "nothing is made for a refused command";
}

TEST(Program, RefusesSettingsByName) {
  const Folder folder;
  const auto with_config = [&](const std::string& json) {
    write_bytes(folder / "config.json", json);
    return track(person_clip(), folder, {"--config", folder / "config.json"});
  };
  EXPECT_TRUE(fails_with(with_config("{\"registration\": {\"edge_factor\": NaN}}"), kExitConfig,
                         {"config.json", "NaN"}));
  EXPECT_TRUE(
      fails_with(with_config("{\"image\": {\"widht\": 160}}"), kExitConfig, {"image.widht", "image.width"}));
  EXPECT_TRUE(fails_with(with_config("{\"seed\": \"one\"}"), kExitConfig, {"seed"}));
  EXPECT_TRUE(fails_with(with_config("[]"), kExitConfig, {"object"}));
  EXPECT_TRUE(fails_with(track(person_clip(), folder, {"--offline", "--method", "two-step"}), kExitUsage,
                         {"offline", "heuristics"}));
  EXPECT_TRUE(fails_with(track(person_clip(), folder, {"--config", folder / "none.json"}), kExitConfig,
                         {"none.json"}));
  EXPECT_TRUE(
      fails_with(track(person_clip(), folder, {"--config", folder.path().string()}), kExitConfig, {}));
  EXPECT_TRUE(fails_with(track(person_clip(), folder, {"--limits", "elastic"}), kExitConfig, {"elastic"}));
  EXPECT_TRUE(
      fails_with(track(person_clip(), folder, {"--limits", folder.path().string()}), kExitConfig, {}));
  EXPECT_TRUE(fails_with(track(person_clip(), folder, {"--smoothing", "butter"}), kExitUsage, {"butter"}));
  EXPECT_TRUE(fails_with(track(person_clip(), folder, {"--height", "17"}), kExitUsage, {"height"}));
  EXPECT_TRUE(fails_with(track(person_clip(), folder, {"--fov", "0"}), kExitUsage, {"fov"}));
  EXPECT_TRUE(fails_with(track(person_clip(), folder, {"--fov", "nan"}), kExitUsage, {"fov"}));
  EXPECT_TRUE(fails_with(track(person_clip(), folder, {"--particles", "0"}), kExitUsage, {"particles"}));
  EXPECT_TRUE(
      fails_with(track(person_clip(), folder, {"--camera", folder / "none.yml"}), kExitConfig, {"none.yml"}));
  EXPECT_TRUE(
      fails_with(track(person_clip(), folder, {"--camera", folder.path().string()}), kExitConfig, {}));
}

TEST(Program, NamesInputsThatCannotBeRead) {
  const Folder folder;
  write_bytes(folder / "empty.mp4", "");
  write_bytes(folder / "words.mp4", "this is no video\n");
  write_bytes(folder / "words.txt", "neither is this\n");
  fs::create_directory(folder / "nothing_in_it");
  for (const char* name : {"missing.mp4", "empty.mp4", "words.mp4", "words.txt", "nothing_in_it"}) {
    EXPECT_TRUE(fails_with(track(folder / name, folder), kExitInput, {name})) << name;
  }
  EXPECT_TRUE(fails_with(track(person_clip(), folder, {"--background", folder / "missing.mp4"}), kExitInput,
                         {"missing.mp4"}));
  EXPECT_TRUE(fails_with(track(person_clip(), folder, {"--background", folder / "empty.mp4"}), kExitInput,
                         {"empty.mp4"}));
}

TEST(Program, PicturesOfNoSizeAreNamed) {
  const Folder folder;
  fs::create_directory(folder / "zero");
  write_bytes(folder / "zero/a.png", "");
  EXPECT_TRUE(fails_with(track(folder / "zero", folder), kExitInput, {}));
  fs::create_directory(folder / "tiny");
  for (const char* name : {"tiny/a.png", "tiny/b.png"}) {
    cv::imwrite(folder / name, cv::Mat(1, 1, CV_8UC3, cv::Scalar(20, 30, 40)));
  }
  const Ended tiny = track(folder / "tiny", folder);
  EXPECT_TRUE(tiny.code == kExitTracking || tiny.code == kExitInput) << tiny.code << ": " << tiny.words;
  EXPECT_EQ(tiny.words.find("unexpected failure"), std::string::npos) << tiny.words;
}

TEST(Program, SaysWhenNobodyIsThere) {
  const Folder folder;
  EXPECT_TRUE(fails_with(track(wall_clip(), folder), kExitTracking, {"nobody was tracked"}));
  EXPECT_TRUE(fs::exists(folder / "out/report.json")) << "the results say so, too";
  EXPECT_TRUE(fs::exists(folder / "out/pose.jsonl"));
}

TEST(Program, SaysThatTheLensIsCovered) {
  const Folder folder;
  write_grey_video(folder / "black.avi", 12, 0);
  EXPECT_TRUE(
      fails_with(track(folder / "black.avi", folder), kExitTracking, {"black", "nobody was tracked"}));
}

TEST(Program, TruncatedVideoIsUsedAsFarAsItGoes) {
  const Folder folder;
  write_grey_video(folder / "cut.avi", 40, 90);
  fs::resize_file(folder / "cut.avi", fs::file_size(folder / "cut.avi") / 2);
  const Ended cut = track(folder / "cut.avi", folder);
  // Nobody is in it; how much of it OpenCV still reads is its own matter.
  EXPECT_TRUE(cut.code == kExitTracking || cut.code == kExitInput) << cut.code << ": " << cut.words;
  EXPECT_EQ(cut.words.find("unexpected failure"), std::string::npos) << cut.words;
  fs::resize_file(folder / "cut.avi", 40);
  EXPECT_TRUE(fails_with(track(folder / "cut.avi", folder), kExitInput, {"cut.avi"}));
}

}  // namespace
}  // namespace telemime::e2e
