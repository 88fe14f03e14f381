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

Ended track(const std::string& input, const Folder& folder, const std::vector<std::string>& more = {}) {
  return run(joined({{"track", input, "--out", folder / "out"}, quickly(), more}));
}

TEST(Program, TellsItsVersionAndHelp) {
  EXPECT_EQ(run({"--version"}).code, 0);
  EXPECT_NE(run({"track", "--help"}).output.find("--background"), std::string::npos);
  EXPECT_EQ(run({"track", "--help"}).code, 0);
}

TEST(Program, WithoutArgumentsSaysWhatCanBeDone) {
  const Ended ended = run({});
  EXPECT_EQ(ended.code, 0);
  for (const char* words : {"amera", "telemime live demo", "telemime track", "telemime doctor", "--help"}) {
    EXPECT_NE(ended.output.find(words), std::string::npos) << words;
  }
}

TEST(Program, DoctorLooksAtEverything) {
  const Ended ended = run({"doctor"});
  for (const char* words :
       {"Cameras", "Networks", "Page", "port 7070", "Processor", "frames per second at --quality balanced"}) {
    EXPECT_NE(ended.output.find(words), std::string::npos) << words << " in\n" << ended.output;
  }
  const bool problem = ended.output.find("PROBLEM") != std::string::npos;
  EXPECT_EQ(ended.code, problem ? kExitConfig : 0);
  EXPECT_EQ(ended.words, "");
}

// Options behind a valid `track`, the exit code, and what the message contains.
struct Refusal {
  std::vector<std::string> options;
  int code;
  std::vector<std::string> causes;
};

void expect_refused(const Folder& folder, const std::vector<Refusal>& refusals) {
  for (const Refusal& refusal : refusals) {
    EXPECT_TRUE(fails_with(track(person_clip(), folder, refusal.options), refusal.code, refusal.causes))
        << refusal.options.front();
  }
}

TEST(Program, RefusesUnknownWords) {
  const Folder folder;
  EXPECT_TRUE(fails_with(run({"dance"}), kExitUsage, {"--help"}));
  EXPECT_TRUE(fails_with(run({"track"}), kExitUsage, {"INPUT"}));
  expect_refused(folder, {{{"--frobnicate"}, kExitUsage, {"--frobnicate"}},
                          {{"--method", "guess"}, kExitUsage, {"guess", "two-step"}},
                          {{"--seed", "many"}, kExitUsage, {"seed"}},
                          {{"--frames", "-1"}, kExitUsage, {"--frames", "-1"}},
                          {{"--set", "image.width"}, kExitUsage, {"NAME=VALUE"}},
                          {{"--set", "="}, kExitUsage, {"no setting ''"}},
                          {{"--set", "image.width=wide"}, kExitUsage, {"'image.width' cannot be \"wide\""}},
                          {{"--set", "image.width=3"}, kExitUsage, {"40 to 1920"}},
                          {{"--set", "image.widht=160"}, kExitUsage, {"'image.width'"}}});
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
  const std::string a_folder = folder.path().string();
  expect_refused(folder, {{{"--config", folder / "none.json"}, kExitConfig, {"none.json"}},
                          {{"--config", a_folder}, kExitConfig, {}},
                          {{"--limits", "elastic"}, kExitConfig, {"elastic"}},
                          {{"--limits", a_folder}, kExitConfig, {}},
                          {{"--smoothing", "butter"}, kExitUsage, {"butter"}},
                          {{"--height", "17"}, kExitUsage, {"height"}},
                          {{"--fov", "0"}, kExitUsage, {"fov"}},
                          {{"--fov", "nan"}, kExitUsage, {"fov"}},
                          {{"--particles", "0"}, kExitUsage, {"particles"}},
                          {{"--camera", folder / "none.yml"}, kExitConfig, {"none.yml"}},
                          {{"--camera", a_folder}, kExitConfig, {}}});
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
  expect_refused(folder, {{{"--background", folder / "missing.mp4"}, kExitInput, {"missing.mp4"}},
                          {{"--background", folder / "empty.mp4"}, kExitInput, {"empty.mp4"}}});
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

TEST(Program, SaysOnceWhatIsWrongWithAnInput) {
  const Folder folder;
  const cv::Mat grey(90, 120, CV_8UC3, cv::Scalar::all(120));
  for (const char* const name : {"gaps/a1.png", "gaps/a2.png", "gaps/a5.png", "broken/a1.png",
                                 "broken/a3.png", "sizes/a1.png", "sizes/a2.png"}) {
    fs::create_directory(fs::path(folder / name).parent_path());
    cv::imwrite(folder / name, grey);
  }
  write_bytes(folder / "broken/a2.png", "no image");
  cv::imwrite(folder / "sizes/a3.png", grey.colRange(0, 60));
  write_grey_video(folder / "-cut.avi", 40, 90);
  fs::resize_file(folder / "-cut.avi", fs::file_size(folder / "-cut.avi") / 2);
  for (const auto& [input, complaint] :
       {std::pair("gaps", "(3 to 4)"), std::pair("broken", "a2.png"), std::pair("sizes", "60x90"),
        std::pair("-cut.avi", "header states 40")}) {
    const Ended ended = track(folder / input, folder);
    EXPECT_EQ(ended.code, kExitTracking) << ended.words;
    const std::size_t at = ended.words.find(complaint);
    EXPECT_NE(at, std::string::npos) << input << ": " << ended.words;
    EXPECT_EQ(ended.words.find(complaint, at + 1), std::string::npos) << input << ": " << ended.words;
  }
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
