// SPDX-License-Identifier: Apache-2.0
#include "telemime/live/kept_outputs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "telemime/core/scratch_folder.h"
#include "telemime/live/live_settings.h"

namespace telemime {
namespace {

// One run of the program, as far as its outputs go.
struct OneRun {
  explicit OneRun(const std::filesystem::path& file, bool resume = false) : kept(file, senders, tell()) {
    kept.offer(resume);
  }
  KeptOutputs::Tell tell() {
    return [this](MessageLevel level, const std::string& words) {
      heard += words + "\n";
      worst = std::max(worst, level);
    };
  }
  void add(const std::string& url) {
    senders.add(url, true);
    kept.changed();
    kept.save();
  }
  SenderState state(std::size_t output) const { return senders.status().at(output).state; }

  std::string heard;
  MessageLevel worst = MessageLevel::info;
  SenderList senders;
  KeptOutputs kept;
};

class Kept : public ::testing::Test {
 protected:
  ScratchFolder folder_;
  std::filesystem::path file_ = folder_.path() / "telemime" / "live.json";
};

TEST_F(Kept, AnOutputIsOfferedAgainAndNotSentTo) {
  {
    OneRun first(file_);
    EXPECT_EQ(first.heard, "");
    first.add("vmc://localhost:39539");
  }
  OneRun second(file_);
  ASSERT_EQ(second.senders.status().size(), 1U);
  EXPECT_EQ(second.state(0), SenderState::off);
  EXPECT_NE(second.heard.find("vmc://localhost:39539"), std::string::npos) << second.heard;
  EXPECT_NE(second.heard.find("--resume-outputs"), std::string::npos) << second.heard;
  second.senders.remove("vmc://localhost");
  second.kept.changed();
  second.kept.save();
  EXPECT_TRUE(OneRun(file_).senders.status().empty()) << "what was removed is not offered again";
}

TEST_F(Kept, IsSentToAgainWhenThisRunAsksForIt) {
  OneRun(file_).add("vmc://localhost:39539");
  const OneRun again(file_, /*resume=*/true);
  EXPECT_NE(again.state(0), SenderState::off);
  EXPECT_NE(again.heard.find("sending again"), std::string::npos) << again.heard;
}

TEST_F(Kept, WithoutAFileNothingIsKept) {
  OneRun run("");
  run.add("vmc://localhost");
  EXPECT_EQ(run.heard, "");
  EXPECT_FALSE(std::filesystem::exists(file_));
}

TEST_F(Kept, NothingIsWrittenWhenNothingWasAdded) {
  OneRun run(file_);
  run.kept.save();
  EXPECT_FALSE(std::filesystem::exists(file_));
}

TEST_F(Kept, ADamagedFileIsToldAndTheRunGoesOn) {
  std::filesystem::create_directories(file_.parent_path());
  std::ofstream(file_) << "{{{";
  OneRun run(file_);
  EXPECT_EQ(run.worst, MessageLevel::warning);
  EXPECT_NE(run.heard.find(file_.string()), std::string::npos) << run.heard;
  run.add("vmc://localhost");
  EXPECT_EQ(load_settings(file_).outputs.size(), 1U);
}

TEST_F(Kept, OneThatIsNoOutputAnyMoreDoesNotKeepTheOthersAway) {
  save_settings(file_, {{"carrier-pigeon://coop", "vmc://localhost", "vmc://localhost?bundle=7"}});
  const OneRun run(file_, /*resume=*/true);
  EXPECT_EQ(run.worst, MessageLevel::warning);
  EXPECT_NE(run.heard.find("carrier-pigeon"), std::string::npos) << run.heard;
  EXPECT_NE(run.state(0), SenderState::off);
}

TEST_F(Kept, WhatCannotBeWrittenIsTold) {
  std::ofstream(folder_.file("telemime")) << "a file where the folder should be";
  OneRun run(file_);
  run.add("vmc://localhost");
  EXPECT_EQ(run.worst, MessageLevel::warning);
  EXPECT_NE(run.state(0), SenderState::off) << "it is sent to all the same";
}

}  // namespace
}  // namespace telemime
