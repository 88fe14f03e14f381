// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/table.h"

#include <gtest/gtest.h>

#include <cmath>

namespace telemime {
namespace {

TEST(Csv, QuotesWhatWouldBreakALine) {
  const Table table{"t", {"a", "b, c"}, {{"1", "two \"2\""}, {"line\nbreak", ""}}};
  EXPECT_EQ(to_csv(table), "a,\"b, c\"\n1,\"two \"\"2\"\"\"\n\"line\nbreak\",\n");
}

TEST(Number, HasFourDigits) {
  EXPECT_EQ(number(0.123456), "0.1235");
  EXPECT_EQ(number(200.0), "200");
  EXPECT_EQ(number(std::nan("")), "-");
}

TEST(TableOf, PutsColumnsSideBySide) {
  const Table table = table_of("t", {{"frame", {0.0, 1.0}}, {"F", {0.25, std::nan("")}}});
  EXPECT_EQ(table.columns, (std::vector<std::string>{"frame", "F"}));
  EXPECT_EQ(table.rows[1], (std::vector<std::string>{"1", "-"}));
}

TEST(Beside, JoinsRowsByTheirFirstField) {
  const Table joined =
      beside({"t", {"k", "ours"}, {{"a", "1"}, {"b", "2"}}}, {"p", {"k", "theirs"}, {{"b", "9"}}});
  EXPECT_EQ(joined.columns, (std::vector<std::string>{"k", "ours", "theirs"}));
  EXPECT_EQ(joined.rows[0].back(), "-");
  EXPECT_EQ(joined.rows[1].back(), "9");
}

TEST(Text, LinesUpColumns) {
  EXPECT_EQ(to_text({"", {"a", "bb"}, {{"long", "1"}}}), "  a     bb\n  long  1\n");
}

}  // namespace
}  // namespace telemime
