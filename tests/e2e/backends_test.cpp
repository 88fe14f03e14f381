// SPDX-License-Identifier: Apache-2.0
// Back ends as a user chooses and measures them, and the experiments.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "cli/exit_codes.h"
#include "run_program.h"
#include "telemime/likelihood/all.h"

namespace telemime::e2e {
namespace {

TEST(Bench, MeasuresTheBackEndsThatWereAskedFor) {
  const ScratchFolder folder;
  const std::string file = (folder.path() / "bench.json").string();
  const Ended ended = run({"bench", "--engine-only", "--quick", "--backend", "simd", "--json", file});
  ASSERT_EQ(ended.code, 0) << ended.words;
  EXPECT_NE(ended.output.find("Thousand evaluations"), std::string::npos);
  EXPECT_EQ(ended.output.find("scalar  "), std::string::npos) << "only simd was asked for";
  std::ifstream in(file);
  const nlohmann::json tables = nlohmann::json::parse(in);
  ASSERT_TRUE(tables.is_array());
  EXPECT_GE(tables.size(), 5U);
}

TEST(Bench, WatchesTheMemory) {
  const Ended ended = run({"bench", "--soak", "0.01"});
  EXPECT_EQ(ended.code, 0) << ended.words;
  EXPECT_NE(ended.output.find("10/10"), std::string::npos);
}

TEST(Backends, ThatCannotRunOrDoNotExistAreRefusedInWords) {
  const Ended unknown = run({"bench", "--engine-only", "--backend", "abacus"});
  EXPECT_EQ(unknown.code, kExitUsage);
  EXPECT_NE(unknown.words.find("simd"), std::string::npos) << "the choices are named: " << unknown.words;
  for (const BackendKind& kind : kBackends) {
    if (!kind.missing().empty()) {
      const Ended ended = run({"bench", "--engine-only", "--backend", std::string(kind.name)});
      EXPECT_EQ(ended.code, kExitUsage);
      EXPECT_NE(ended.words.find(kind.missing()), std::string::npos) << ended.words;
    }
  }
}

TEST(Experiments, OneThatCannotBeMeasuredDoesNotStopTheOthers) {
  const Folder folder;
  const Ended ended =
      run({"experiments", "F4-33", "T4-1", "--quick", "--data", folder / "nothing", "--out", folder / "out"});
  EXPECT_EQ(ended.code, kExitTracking);
  EXPECT_NE(ended.words.find("F4-33  not measured"), std::string::npos) << ended.words;
  EXPECT_NE(ended.output.find("T4-1"), std::string::npos) << ended.output;
  EXPECT_TRUE(std::filesystem::exists(folder / "out/T4-1"));
  EXPECT_FALSE(std::filesystem::exists(folder / "out/F4-33"));
}

TEST(Experiments, WithoutRealClipsTheGesturesAreTakenWithTheirBackground) {
  const Folder folder;
  const std::filesystem::path clip = folder / "raising_arms";
  std::filesystem::create_directory(clip);
  std::filesystem::create_directory_symlink(person_clip(), clip / "video.mkv");
  std::filesystem::create_directory_symlink(wall_clip(), clip / "background.mkv");
  const Ended ended =
      run({"experiments", "F4-33", "--quick", "--data", folder.path().string(), "--out", folder / "out"});
  EXPECT_EQ(ended.code, 0) << ended.words;
  EXPECT_NE(ended.output.find("raising_arms"), std::string::npos) << ended.output;
}

}  // namespace
}  // namespace telemime::e2e
