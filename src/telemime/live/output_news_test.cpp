// SPDX-License-Identifier: Apache-2.0
#include "telemime/live/output_news.h"

#include <gtest/gtest.h>

namespace telemime {
namespace {

SenderStatus output(const std::string& url, SenderState state, const std::string& words = "") {
  SenderStatus status;
  status.url = url;
  status.state = state;
  status.words = words;
  return status;
}

std::string look(OutputNews& news, const std::vector<SenderStatus>& outputs) {
  std::string all;
  for (const OutputNews::Words& one : news.look(outputs)) {
    all += (one.level == MessageLevel::warning ? "! " : "") + one.words + "\n";
  }
  return all;
}

TEST(OutputNews, TellsAFailureOnceAndItsEnd) {
  OutputNews news;
  EXPECT_EQ(look(news, {output("vmc://a", SenderState::connecting)}), "");
  EXPECT_EQ(look(news, {output("vmc://a", SenderState::failed, "no such computer")}),
            "! vmc://a: no such computer\n");
  EXPECT_EQ(look(news, {output("vmc://a", SenderState::connecting)}), "");
  EXPECT_EQ(look(news, {output("vmc://a", SenderState::failed, "no such computer")}), "");
  EXPECT_EQ(look(news, {output("vmc://a", SenderState::sending)}), "vmc://a: sending now\n");
  EXPECT_EQ(look(news, {output("vmc://a", SenderState::sending)}), "");
  EXPECT_EQ(look(news, {output("vmc://a", SenderState::failed, "gone")}), "! vmc://a: gone\n");
}

TEST(OutputNews, WhatIsSwitchedOffOrRemovedIsForgotten) {
  OutputNews news;
  const SenderStatus failed = output("vmc://a", SenderState::failed, "gone");
  EXPECT_EQ(look(news, {failed, output("vmc://b", SenderState::sending)}), "! vmc://a: gone\n");
  EXPECT_EQ(look(news, {output("vmc://a", SenderState::off), output("vmc://b", SenderState::sending)}), "");
  EXPECT_EQ(look(news, {failed}), "! vmc://a: gone\n");
  EXPECT_EQ(look(news, {}), "");
  EXPECT_EQ(look(news, {failed}), "! vmc://a: gone\n");
}

}  // namespace
}  // namespace telemime
