// SPDX-License-Identifier: Apache-2.0
#include "telemime/live/saved_outputs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "telemime/core/scratch_folder.h"
#include "telemime/live/testing_settings.h"

namespace telemime {
namespace {

// One run of the program, as far as its outputs go.
struct OneRun {
  explicit OneRun(const std::filesystem::path& file, bool resume = false) : saved(file, senders, report()) {
    saved.offer(resume);
  }
  SavedOutputs::Report report() {
    return [this](MessageLevel level, const std::string& words) {
      reported += words + "\n";
      worst = std::max(worst, level);
    };
  }
  void add(const std::string& url) {
    senders.add(url);
    saved.keep(url);
    saved.save();
  }
  void remove(const std::string& url) {
    senders.remove(url);
    saved.forget(url);
    saved.save();
  }
  SenderState state(std::size_t output) const { return senders.status().at(output).state; }

  std::string reported;
  MessageLevel worst = MessageLevel::info;
  SenderList senders;
  SavedOutputs saved;
};

class Saved : public ::testing::Test {
 protected:
  ScratchFolder folder_;
  std::filesystem::path file_ = folder_.path() / "telemime" / "live.json";
};

TEST_F(Saved, OutputOfAnEarlierRunIsListedOff) {
  {
    OneRun first(file_);
    EXPECT_EQ(first.reported, "");
    first.add("vmc://localhost:39539");
  }
  OneRun second(file_);
  ASSERT_EQ(second.senders.status().size(), 1U);
  EXPECT_EQ(second.state(0), SenderState::off);
  EXPECT_NE(second.reported.find("vmc://localhost:39539"), std::string::npos) << second.reported;
  EXPECT_NE(second.reported.find("--resume-outputs"), std::string::npos) << second.reported;
  second.remove("vmc://localhost");
  EXPECT_TRUE(OneRun(file_).senders.status().empty()) << "a removed output is not listed again";
}

TEST_F(Saved, ResumeSendsAgain) {
  OneRun(file_).add("vmc://localhost:39539");
  const OneRun again(file_, /*resume=*/true);
  EXPECT_NE(again.state(0), SenderState::off);
  EXPECT_NE(again.reported.find("sending again"), std::string::npos) << again.reported;
}

TEST_F(Saved, WithoutAFileNothingIsSaved) {
  OneRun run("");
  run.add("vmc://localhost");
  EXPECT_EQ(run.reported, "");
  EXPECT_FALSE(std::filesystem::exists(file_));
}

TEST_F(Saved, NoChangeWritesNothing) {
  OneRun run(file_);
  run.saved.save();
  EXPECT_FALSE(std::filesystem::exists(file_));
}

TEST_F(Saved, DamagedFileIsReported) {
  std::filesystem::create_directories(file_.parent_path());
  std::ofstream(file_) << "{{{";
  OneRun run(file_);
  EXPECT_EQ(run.worst, MessageLevel::warning);
  EXPECT_NE(run.reported.find(file_.string()), std::string::npos) << run.reported;
  run.add("vmc://localhost");
  EXPECT_EQ(load_settings(file_).size(), 1U);
}

TEST_F(Saved, UnknownOutputDoesNotBlockTheOthers) {
  save_settings(file_, {"carrier-pigeon://coop", "vmc://localhost", "vmc://localhost?bundle=7"});
  const OneRun run(file_, /*resume=*/true);
  EXPECT_EQ(run.worst, MessageLevel::warning);
  EXPECT_NE(run.reported.find("carrier-pigeon"), std::string::npos) << run.reported;
  EXPECT_NE(run.state(0), SenderState::off);
}

TEST_F(Saved, ConcurrentRunsPreserveChanges) {
  save_settings(file_, {"vmc://old", "carrier-pigeon://coop"});
  OneRun one(file_);
  OneRun other(file_);
  one.add("vmc://one");
  other.add("vmc://other");
  other.add("vmc://one:39539");
  EXPECT_EQ(load_settings(file_),
            (std::vector<std::string>{"vmc://old", "carrier-pigeon://coop", "vmc://one", "vmc://other"}));
  one.remove("vmc://old:39539");
  other.remove("vmc://other");
  EXPECT_EQ(load_settings(file_), (std::vector<std::string>{"carrier-pigeon://coop", "vmc://one"}));
}

TEST_F(Saved, MoreThanTheLimitArePreserved) {
  std::vector<std::string> many;
  for (int i = 0; i < 20; ++i) {
    many.push_back("vmc://h" + std::to_string(i));
  }
  save_settings(file_, many);
  OneRun run(file_);
  EXPECT_EQ(run.senders.status().size(), 16U);
  run.remove("vmc://h3");
  run.add("vmc://new");
  many.erase(many.begin() + 3);
  many.emplace_back("vmc://new");
  EXPECT_EQ(load_settings(file_), many);
}

TEST_F(Saved, FailedWriteIsRepeatedAtTheNextChange) {
  std::ofstream(folder_.file("telemime")) << "a file where the folder should be";
  OneRun run(file_);
  run.add("vmc://one");
  EXPECT_EQ(run.worst, MessageLevel::warning);
  run.reported.clear();
  run.saved.save();
  EXPECT_EQ(run.reported, "") << "it is reported once";
  std::filesystem::remove(folder_.file("telemime"));
  run.add("vmc://two");
  EXPECT_EQ(load_settings(file_), (std::vector<std::string>{"vmc://one", "vmc://two"}));
}

TEST_F(Saved, PasswordIsNotSaved) {
  OneRun run(file_);
  run.saved.keep("other://anna:secret@host/x");
  run.saved.save();
  ASSERT_EQ(load_settings(file_).size(), 1U);
  EXPECT_EQ(load_settings(file_)[0].find("secret"), std::string::npos);
}

TEST_F(Saved, FailedWriteIsReported) {
  std::ofstream(folder_.file("telemime")) << "a file where the folder should be";
  OneRun run(file_);
  run.add("vmc://localhost");
  EXPECT_EQ(run.worst, MessageLevel::warning);
  EXPECT_NE(run.state(0), SenderState::off) << "it sends nevertheless";
}

}  // namespace
}  // namespace telemime
