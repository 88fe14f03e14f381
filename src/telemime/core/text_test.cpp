// SPDX-License-Identifier: Apache-2.0
#include "telemime/core/text.h"

#include <gtest/gtest.h>

#include <vector>

namespace telemime {
namespace {

TEST(Text, LowerCaseLeavesOtherBytesAlone) {
  EXPECT_EQ(lower_case("AZaz09[\xC3\x84"), "azaz09[\xC3\x84");
}

TEST(Text, PercentEncodedBytesAreDecoded) {
  EXPECT_EQ(percent_decoded(""), "");
  EXPECT_EQ(percent_decoded("J%C3%B6rg%20%25"), "J\xc3\xb6rg %");
  for (const char* const bad : {"%", "%4", "a%4", "%zz", "%4z", "% 4", "%-1", "%+1"}) {
    EXPECT_FALSE(percent_decoded(bad)) << bad;
  }
}

TEST(Text, ListsAreJoinedByCommas) {
  EXPECT_EQ(joined(std::vector<std::string>{}), "");
  EXPECT_EQ(joined(std::vector<std::string_view>{"a", "b"}), "a, b");
  struct Named {
    std::string_view name;
  };
  EXPECT_EQ(joined(std::vector<Named>{{"x"}, {"y"}}, &Named::name), "x, y");
}

TEST(Utf8, TheEdgesOfEachLengthAreChecked) {
  for (const char* good : {"a", "\xC2\xA0", "\xDF\xBF", "\xE0\xA0\x80", "\xED\x9F\xBF", "\xEE\x80\x80",
                           "\xEF\xBF\xBF", "\xF0\x90\x80\x80", "\xF4\x8F\xBF\xBF"}) {
    EXPECT_EQ(printable_length(good), 1U) << good;
  }
  EXPECT_EQ(printable_length(""), 0U);
  for (const char* bad : {"\x80", "\xC1\xBF", "\xC2", "\xE0\x9F\xBF", "\xED\xA0\x80", "\xF0\x8F\xBF\xBF",
                          "\xF4\x90\x80\x80", "\xF5\x80\x80\x80", "\xE1\x80", "a\xFE"}) {
    EXPECT_FALSE(printable_length(bad)) << bad;
  }
}

TEST(Utf8, ControlCharactersAreNotPrintable) {
  for (const char* bad : {"\x01", "a\n", "\x1F", "\x7F", "\xC2\x80", "\xC2\x9F"}) {
    EXPECT_FALSE(printable_length(bad)) << bad;
  }
  EXPECT_FALSE(printable_length(std::string_view("\0", 1)));
}

}  // namespace
}  // namespace telemime
