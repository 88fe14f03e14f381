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

TEST(Html, Escapes) {
  EXPECT_NE(to_html({"", {"<b>"}, {{"a & b"}}}).find("<th>&lt;b&gt;</th>"), std::string::npos);
}

TEST(Text, LinesUpColumns) {
  EXPECT_EQ(to_text({"", {"a", "bb"}, {{"long", "1"}}}), "  a     bb\n  long  1\n");
}

}  // namespace
}  // namespace telemime
