// SPDX-License-Identifier: Apache-2.0
#include "telemime/live/commands.h"

#include <gtest/gtest.h>

#include "telemime/core/random.h"
#include "telemime/core/testing_errors.h"

namespace telemime {
namespace {

std::string refusal(std::string_view text) {
  return error_of(ErrorKind::usage, [&] { parse_command(text); });
}

TEST(Commands, AreRead) {
  EXPECT_EQ(std::get<Guide>(parse_command(R"({"type":"guide","step":"skip"})")).step, GuideStep::skip);
  EXPECT_TRUE(std::holds_alternative<Recalibrate>(parse_command(R"({"type":"recalibrate"})")));
  EXPECT_EQ(std::get<AddOutput>(parse_command(R"({"type":"output","add":"vmc://localhost"})")).url,
            "vmc://localhost");
  EXPECT_EQ(std::get<SwitchOutputOff>(parse_command(R"({"type":"output","off":"ws://a"})")).url, "ws://a");
  EXPECT_EQ(std::get<RemoveOutput>(parse_command(R"({"type":"output","remove":"ws://a"})")).url, "ws://a");
  EXPECT_TRUE(std::get<Record>(parse_command(R"({"type":"record","on":true})")).on);
  EXPECT_EQ(std::get<Forget>(parse_command(R"({"type":"forget","recording":3})")).number, 3);
  EXPECT_FALSE(std::get<Pictures>(parse_command(R"({"type":"pictures","on":false})")).on);
  EXPECT_TRUE(std::get<Poses>(parse_command(R"({"type":"poses","on":true})")).on);
  const auto drawn = std::get<Drawn>(parse_command(R"({"type":"drawn","frame":12,"stamp":1234.5})"));
  EXPECT_EQ(drawn.frame, 12);
  EXPECT_EQ(drawn.stamp, 1234.5);
  EXPECT_EQ(std::get<Ping>(parse_command(R"({"type":"ping","id":7,"more":[1,2]})")).id, 7);
}

TEST(Commands, AnythingElseIsRefusedInWords) {
  for (const char* text : {"",
                           "7",
                           "[]",
                           "null",
                           "{",
                           "{}",
                           R"({"type":7})",
                           R"({"type":"dance"})",
                           R"({"type":"guide"})",
                           R"({"type":"guide","step":"jump"})",
                           R"({"type":"output"})",
                           R"({"type":"output","add":7})",
                           R"({"type":"output","off":true})",
                           R"({"type":"poses"})",
                           R"({"type":"record"})",
                           R"({"type":"record","on":1})",
                           R"({"type":"forget","recording":-1})",
                           R"({"type":"forget","recording":1e300})",
                           R"({"type":"drawn","frame":1})",
                           R"({"type":"drawn","frame":1,"stamp":"now"})",
                           R"({"type":"ping","id":1.5})"}) {
    EXPECT_NE(refusal(text).find("invalid message"), std::string::npos) << text;
  }
  EXPECT_NE(refusal(std::string(10000, '[')).find("deep"), std::string::npos);
  EXPECT_NE(refusal(R"({"x":"]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]","y":)" + std::string(30, '[')).find("deep"),
            std::string::npos);
  EXPECT_EQ(refusal(R"({"type":"ping","id":1,"x":"[[[[[[[[[[[[[[[[[[[[[[[[[[[[[["})"), "")
      << "brackets in a text";
  EXPECT_NE(refusal(R"({"type":"output","add":")" + std::string(5000, 'a') + "\"}").find("2000"),
            std::string::npos);
}

TEST(Commands, RandomChangesAreReadOrRefused) {
  const std::string valid =
      R"({"type":"drawn","frame":12,"stamp":1234.5,"add":"vmc://localhost:39539","on":true})";
  Random random(11);
  int refused = 0;
  for (int i = 0; i < 20000; ++i) {
    std::string text = valid;
    for (int change = 0; change < 1 + i % 4; ++change) {
      const auto at = static_cast<std::size_t>(random.uniform(0.0, static_cast<double>(text.size())));
      text[at] = static_cast<char>(static_cast<unsigned char>(random.uniform(0.0, 256.0)));
    }
    refused += refusal(text).empty() ? 0 : 1;
  }
  EXPECT_GT(refused, 10000);
}

}  // namespace
}  // namespace telemime
