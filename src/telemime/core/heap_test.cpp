// SPDX-License-Identifier: Apache-2.0
#include "telemime/core/heap.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstddef>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "telemime/core/sanitizers.h"

namespace telemime {
namespace {

// Bytes of this process in memory.
double held() {
  std::ifstream statm("/proc/self/statm");
  double all = 0.0;
  double resident = 0.0;
  statm >> all >> resident;
  return resident * static_cast<double>(::sysconf(_SC_PAGESIZE));
}

TEST(Heap, WhatIsFreeBelowALastPieceGoesBack) {
#if !defined(__GLIBC__) || TELEMIME_ADDRESS_SANITIZER || TELEMIME_THREAD_SANITIZER
  GTEST_SKIP() << "the heap here is not glibc's";
#endif
  constexpr std::size_t kPieces = 32768;
  constexpr std::size_t kBytes = 1000;  // too small for a mapping of its own
  std::vector<std::unique_ptr<std::string>> pieces;
  for (std::size_t i = 0; i < kPieces; ++i) {
    pieces.push_back(std::make_unique<std::string>(kBytes, 'x'));
  }
  const auto last =
      std::move(pieces.back());  // holds the end of the heap, which is all that free() gives back
  const double full = held();
  pieces.clear();
  ASSERT_GT(held(), full - 0.25 * kPieces * kBytes) << "nothing was left to give back";
  EXPECT_TRUE(give_heap_back());
  EXPECT_LT(held(), full - 0.75 * kPieces * kBytes);
  EXPECT_EQ(*last, std::string(kBytes, 'x'));
}

}  // namespace
}  // namespace telemime
