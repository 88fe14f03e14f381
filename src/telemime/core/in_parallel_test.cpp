// SPDX-License-Identifier: Apache-2.0
#include "telemime/core/in_parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>

namespace telemime {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using std::chrono::steady_clock;

// With one processor the tasks run one after the other: none waits for ever.
void wait_for(const std::atomic<bool>& flag) {
  const auto end = steady_clock::now() + seconds(5);
  while (!flag && steady_clock::now() < end) {
    std::this_thread::yield();
  }
}

TEST(InParallel, RunsAllAndPassesAnExceptionOn) {
  for (const int threads : {1, 4}) {
    std::atomic<int> ran = 0;
    on_threads(threads, [&] { in_parallel([&] { ++ran; }, [&] { ++ran; }, [&] { ++ran; }); });
    EXPECT_EQ(ran, 3);
    EXPECT_THROW(on_threads(threads, [] { in_parallel([] { throw std::out_of_range("first"); }, [] {}); }),
                 std::out_of_range);
  }
}

TEST(InParallel, UsesNoMoreThreadsThanProcessors) {
  constexpr int kMany = 500;
  EXPECT_EQ(usable_threads(1), 1);
  EXPECT_EQ(usable_threads(kMany), usable_threads(0));
  testing::internal::CaptureStderr();
  std::atomic<int> ran = 0;
  on_threads(kMany, [&] { in_parallel([&] { ++ran; }, [&] { ++ran; }); });
  EXPECT_EQ(ran, 2);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");  // TBB would warn
}

TEST(InParallel, AnExceptionOutsideEndsNothingInside) {
  std::atomic<bool> inside = false;
  std::atomic<bool> thrown = false;
  std::atomic<int> ran = 0;
  const auto outer = [&] {
    wait_for(inside);
    thrown = true;
    throw std::out_of_range("outer");
  };
  const auto nesting = [&] {
    inside = true;
    wait_for(thrown);
    std::this_thread::sleep_for(milliseconds(50));  // until TBB has caught it
    in_parallel([&] { ++ran; }, [&] { ++ran; }, [&] { ++ran; });
  };
  EXPECT_THROW(on_threads(2, [&] { in_parallel(outer, nesting); }), std::out_of_range);
  if (!inside) {
    GTEST_SKIP() << "there is one processor: the tasks ran one after the other";
  }
  EXPECT_EQ(ran, 3);
}

}  // namespace
}  // namespace telemime
