// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracking/parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>
#include <string>

namespace telemime {
namespace {

// The part that the name of an angle or segment suggests.
Part part_named(const std::string& name) {
  if (name.starts_with("l_")) {
    return Part::left_arm;
  }
  if (name.starts_with("r_")) {
    return Part::right_arm;
  }
  return name.starts_with("neck") || name == "head" ? Part::head : Part::trunk;
}

TEST(Parts, AnglesAndSegmentsMatchTheirNames) {
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(part_of_number(i), Part::trunk) << i;
  }
  for (std::size_t a = 0; a < kAngleCount; ++a) {
    EXPECT_EQ(part_of_number(3 + a), part_named(std::string(kAngleNames[a]))) << kAngleNames[a];
  }
  for (std::size_t s = 0; s < kSegmentCount; ++s) {
    EXPECT_EQ(part_of_segment(static_cast<Segment>(s)), part_named(std::string(kSegmentNames[s])))
        << kSegmentNames[s];
  }
}

TEST(Parts, HaveEveryNumberOnceAndRising) {
  std::multiset<std::size_t> seen;
  for (std::size_t part = 0; part < kPartCount; ++part) {
    const std::vector<std::size_t> numbers = numbers_of(PartSet().set(part));
    EXPECT_FALSE(numbers.empty()) << kPartNames[part];
    EXPECT_TRUE(std::is_sorted(numbers.begin(), numbers.end())) << kPartNames[part];
    seen.insert(numbers.begin(), numbers.end());
  }
  std::vector<std::size_t> all(kPoseSize);
  std::iota(all.begin(), all.end(), std::size_t{0});
  EXPECT_EQ(std::vector<std::size_t>(seen.begin(), seen.end()), all);
  EXPECT_EQ(numbers_of(all_parts()), all);
  EXPECT_TRUE(numbers_of(PartSet()).empty());
}

TEST(Parts, BothArmsHaveTheSameNumbersInTheMirror) {
  Pose left;
  for (const std::size_t i : numbers_of(PartSet().set(static_cast<std::size_t>(Part::left_arm)))) {
    left.angles[i - 3] = 0.01 * static_cast<double>(i);
  }
  const PoseVector seen = mirrored(left).vector() - Pose{}.vector();
  for (std::size_t i = 3; i < kPoseSize; ++i) {
    EXPECT_EQ(seen[static_cast<Eigen::Index>(i)] != 0.0, part_of_number(i) == Part::right_arm)
        << kAngleNames[i - 3];
  }
}

}  // namespace
}  // namespace telemime
