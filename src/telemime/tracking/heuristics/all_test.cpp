// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracking/heuristics/all.h"

#include <gtest/gtest.h>

#include <set>

#include "telemime/core/testing_errors.h"

namespace telemime {
namespace {

std::vector<std::string_view> parsed(const std::string& names) {
  std::vector<std::string_view> found;
  for (const Heuristic* heuristic : parse_heuristics(names)) {
    found.push_back(heuristic->name);
  }
  return found;
}

using Names = std::vector<std::string_view>;

TEST(Heuristics, HaveNamesOfTheirOwn) {
  std::set<std::string_view> names;
  for (const Heuristic& h : kHeuristics) {
    EXPECT_TRUE(names.insert(h.name).second) << h.name;
    EXPECT_EQ(h.name.find_first_of(", \t"), std::string_view::npos) << "it stands in lists";
    EXPECT_FALSE(h.name.empty());
    EXPECT_NE(h.run, nullptr) << h.name;
  }
}

TEST(Heuristics, AreFoundByName) {
  for (const Heuristic& h : kHeuristics) {
    const auto found = parse_heuristics(std::string(h.name));
    ASSERT_EQ(found.size(), 1U) << h.name;
    EXPECT_EQ(found[0], &h);
  }
  EXPECT_EQ(parse_heuristics(heuristic_names()).size(), kHeuristics.size());
}

TEST(Heuristics, RunInStageOrderWhateverTheList) {
  EXPECT_EQ(parsed("kf,lo,hpm,wd,modes"), (Names{"modes", "wd", "hpm", "lo", "kf"}));
  EXPECT_EQ(parsed("wd,wd,wd"), (Names{"wd"}));
  const auto all = parse_heuristics(heuristic_names());
  for (std::size_t i = 1; i < all.size(); ++i) {
    EXPECT_LE(all[i - 1]->stage, all[i]->stage);
  }
}

TEST(Heuristics, BlanksDoNotMatterAndNoneIsCondensation) {
  EXPECT_EQ(parsed(" wd ,  lo"), (Names{"wd", "lo"}));
  EXPECT_EQ(parsed(""), Names{});
}

TEST(Heuristics, UnknownNamesAreNamedWithTheChoices) {
  for (const std::string wrong : {"WD", "wd lo", "x"}) {
    const std::string message =
        testing_errors::message_of(ErrorKind::usage, [&] { parse_heuristics("lo," + wrong); });
    EXPECT_TRUE(testing_errors::names(message, "'" + wrong + "'")) << message;
    EXPECT_TRUE(testing_errors::names(message, heuristic_names())) << message;
  }
  EXPECT_THROW(parse_heuristics("wd,,lo"), Error);
}

}  // namespace
}  // namespace telemime
