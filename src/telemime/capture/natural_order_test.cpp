// SPDX-License-Identifier: Apache-2.0
#include "telemime/capture/natural_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace telemime {
namespace {

// In ascending order.
const std::vector<std::string> sorted = {"",
                                         "1",
                                         "01",
                                         "2",
                                         "10",
                                         "a",
                                         "a1",
                                         "a1b",
                                         "a2",
                                         "a10",
                                         "a99999999999999999999998",
                                         "a99999999999999999999999",
                                         "b",
                                         "frame2.png",
                                         "frame10.png",
                                         "frame10b.png",
                                         "z"};

TEST(NaturalOrder, EveryPairIsOrderedOneWayOnly) {
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    for (std::size_t j = 0; j < sorted.size(); ++j) {
      EXPECT_EQ(natural_less(sorted[i], sorted[j]), i < j) << sorted[i] << " and " << sorted[j];
    }
  }
}

TEST(NaturalOrder, SortsAnyPermutationTheSameWay) {
  std::vector<std::string> names = sorted;
  std::reverse(names.begin(), names.end());
  std::sort(names.begin(), names.end(), natural_less);
  EXPECT_EQ(names, sorted);
}

}  // namespace
}  // namespace telemime
