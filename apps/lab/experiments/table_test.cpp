// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/table.h"

#include <gtest/gtest.h>

#include <cmath>

#include "telemime/core/errors.h"

namespace telemime {
namespace {

TEST(Csv, ReadsWhatItWrites) {
  const Table table{"t", {"a", "b, c"}, {{"1", "two \"2\""}, {"line\nbreak", ""}}};
  const Table read = parse_csv(to_csv(table), "t");
  EXPECT_EQ(read.columns, table.columns);
  EXPECT_EQ(read.rows, table.rows);
}

TEST(Csv, RefusesRaggedRows) {
  EXPECT_THROW(parse_csv("a,b\n1\n", "t"), Error);
  EXPECT_TRUE(parse_csv("", "t").columns.empty());
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
