// SPDX-License-Identifier: Apache-2.0
#include "telemime/live/live_answers.h"

#include <gtest/gtest.h>

#include <vector>

#include "telemime/core/scratch_folder.h"

namespace telemime {
namespace {

using Urls = std::vector<std::string>;
constexpr std::uint64_t kHere = 1;
constexpr std::uint64_t kElsewhere = 2;

class Answers : public ::testing::Test {
 protected:
  std::string ask(std::uint64_t client, const std::string& what, const std::string& url) {
    return answers_(client, R"({"type":"output",")" + what + R"(":")" + url + R"("})").value_or("");
  }
  Urls listed() const {
    Urls urls;
    for (const SenderStatus& output : senders_.status()) {
      urls.push_back(output.url);
    }
    return urls;
  }

  ScratchFolder folder_;
  Recorder recorder_{folder_.path() / "r", OutputOptions(), {}};
  SenderList senders_;
  Urls kept_;
  Urls forgotten_;
  LiveAnswers answers_{
      recorder_,
      senders_,
      monotonic_clock(),
      {[](std::uint64_t, int, bool) {}, [] {}, [](std::uint64_t client) { return client == kHere; },
       [this](const std::string& url) { kept_.push_back(url); },
       [this](const std::string& url) { forgotten_.push_back(url); }}};
};

TEST_F(Answers, WhatIsAddedHereIsKeptForLaterRuns) {
  EXPECT_EQ(ask(kHere, "add", "vmc://localhost"), "");
  EXPECT_EQ(kept_, Urls{"vmc://localhost"});
  EXPECT_NE(ask(kHere, "add", "vmc://localhost"), "") << "twice";
  EXPECT_NE(ask(kHere, "add", "pigeon://coop"), "");
  EXPECT_EQ(kept_.size(), 1U);
  EXPECT_EQ(ask(kHere, "off", "vmc://localhost"), "");
  EXPECT_TRUE(forgotten_.empty());
  EXPECT_EQ(ask(kHere, "remove", "vmc://localhost"), "");
  EXPECT_EQ(forgotten_, Urls{"vmc://localhost"});
  EXPECT_NE(ask(kHere, "remove", "vmc://localhost"), "");
  EXPECT_EQ(forgotten_.size(), 1U);
}

TEST_F(Answers, ARefusalSaysWhichAddressItIsAbout) {
  for (int i = 0; i < 16; ++i) {
    EXPECT_EQ(ask(kHere, "add", "vmc://h" + std::to_string(i)), "");
  }
  EXPECT_NE(ask(kHere, "add", "vmc://one-more").find("vmc://one-more"), std::string::npos);
  const std::string words = ask(kHere, "add", "pigeon://ana:secret@coop");
  EXPECT_NE(words.find("pigeon://ana@coop"), std::string::npos) << words;
  EXPECT_EQ(words.find("secret"), std::string::npos) << words;
}

TEST_F(Answers, ARecordingIsKnownAtOnce) {
  EXPECT_FALSE(recorder_.current());
  EXPECT_EQ(answers_(kHere, R"({"type":"record","on":true})"), std::nullopt);
  ASSERT_TRUE(recorder_.current()) << "it waits for a person";
  EXPECT_EQ(recorder_.current()->frames, 0);
  answers_(kHere, R"({"type":"record","on":false})");
  EXPECT_FALSE(recorder_.current());
}

TEST_F(Answers, AVisitorFromElsewhereChangesThisRunAlone) {
  EXPECT_EQ(ask(kElsewhere, "add", "vmc://localhost"), "");
  EXPECT_EQ(listed(), Urls{"vmc://localhost"});
  EXPECT_EQ(ask(kElsewhere, "remove", "vmc://localhost"), "");
  EXPECT_TRUE(listed().empty());
  EXPECT_TRUE(kept_.empty());
  EXPECT_TRUE(forgotten_.empty());
}

}  // namespace
}  // namespace telemime
