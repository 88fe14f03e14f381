// SPDX-License-Identifier: Apache-2.0
#include "telemime/capture/playback.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <thread>

#include "telemime/core/errors.h"
#include "telemime/core/testing_errors.h"

namespace telemime {
namespace {

/// Frames without images, ten per second.
class TenASecond : public Source {
 public:
  explicit TenASecond(std::int64_t frames) : frames_(frames) {
    info_.fps = 10.0;
    info_.frames = frames;
  }
  const SourceInfo& info() const override { return info_; }
  std::string complaint() const override { return "as the file says"; }
  std::optional<Frame> next() override {
    if (index_ == frames_) {
      return std::nullopt;
    }
    const std::int64_t index = index_++;
    return Frame{{}, index, static_cast<double>(index) / 10.0};
  }

 private:
  SourceInfo info_;
  std::int64_t frames_;
  std::int64_t index_ = 0;
};

/// A clock that advances only on request or when waited for.
struct FakeTime {
  double seconds = 1000.0;
  Clock clock() {
    return {[this] { return seconds; }, [this](double until) { seconds = std::max(seconds, until); }};
  }
};

TEST(Loop, TimeAndIndexContinue) {
  const auto source = loop([] { return std::make_unique<TenASecond>(3); });
  EXPECT_EQ(source->info().frames, 0) << "nobody knows how many";
  for (int i = 0; i < 10; ++i) {
    const auto frame = source->next();
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->index, i);
    EXPECT_NEAR(frame->time, i / 10.0, 1e-9);
  }
}

TEST(Loop, EndsOnAnEmptyFile) {
  const auto source = loop([] { return std::make_unique<TenASecond>(0); });
  EXPECT_FALSE(source->next());
}

TEST(Loop, EndsWhenTheFileIsGone) {
  int opened = 0;
  const auto source = loop([&opened]() -> std::unique_ptr<Source> {
    if (opened++ > 0) {
      throw Error(ErrorKind::input, "it is gone");
    }
    return std::make_unique<TenASecond>(1);
  });
  EXPECT_TRUE(source->next());
  EXPECT_FALSE(source->next());
  EXPECT_NE(source->complaint().find("gone"), std::string::npos);
}

TEST(Paced, FastConsumerGetsAllFramesInTime) {
  FakeTime time;
  const std::unique_ptr<Source> source = pace(std::make_unique<TenASecond>(5), time.clock());
  EXPECT_TRUE(source->info().live);
  for (int i = 0; i < 5; ++i) {
    const std::optional<Frame> frame = source->next();
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->index, i);
    EXPECT_NEAR(time.seconds, 1000.0 + i / 10.0, 1e-9);
  }
  EXPECT_FALSE(source->next());
  EXPECT_EQ(source->complaint(), "as the file says");
}

TEST(Paced, SlowFileIsPlayedMoreSlowly) {
  /// Reading a frame takes two and a half times its duration.
  class SlowToRead : public TenASecond {
   public:
    explicit SlowToRead(FakeTime& time) : TenASecond(1000), time_(time) {}
    std::optional<Frame> next() override {
      time_.seconds += 0.25;
      return TenASecond::next();
    }

   private:
    FakeTime& time_;
  };
  FakeTime time;
  const std::unique_ptr<Source> source = pace(std::make_unique<SlowToRead>(time), time.clock());
  std::int64_t before = source->next()->index;
  for (int i = 0; i < 30; ++i) {
    const std::optional<Frame> frame = source->next();
    ASSERT_TRUE(frame);
    EXPECT_GT(frame->index, before);
    EXPECT_LE(frame->index, before + 12) << i;
    EXPECT_LE(frame->taken, time.seconds);
    before = frame->index;
  }
}

TEST(Paced, SlowConsumerGetsTheNewestFrame) {
  FakeTime time;
  const std::unique_ptr<Source> source = pace(std::make_unique<TenASecond>(10), time.clock());
  EXPECT_EQ(source->next()->index, 0);
  time.seconds += 0.35;
  EXPECT_EQ(source->next()->index, 3);  // it did not wait: frames 1 and 2 are gone
  EXPECT_NEAR(time.seconds, 1000.35, 1e-9);
  EXPECT_EQ(source->next()->index, 4);
  EXPECT_NEAR(time.seconds, 1000.4, 1e-9);
  time.seconds += 60.0;
  EXPECT_EQ(source->next()->index, 9);
  EXPECT_FALSE(source->next());
}

TEST(Paced, TimeBeforeTheFirstFrameDoesNotCount) {
  FakeTime time;
  const std::unique_ptr<Source> source = pace(std::make_unique<TenASecond>(3), time.clock());
  time.seconds += 60.0;
  EXPECT_EQ(source->next()->index, 0);
  EXPECT_EQ(source->next()->index, 1);
}

TEST(Paced, EmptyFileEndsAtOnce) {
  FakeTime time;
  EXPECT_FALSE(pace(std::make_unique<TenASecond>(0), time.clock())->next());
}

/// Two frames, an hour apart.
class LongPause : public TenASecond {
 public:
  LongPause() : TenASecond(2) {}
  std::optional<Frame> next() override {
    auto frame = TenASecond::next();
    if (frame) {
      frame->time *= 36000.0;
    }
    return frame;
  }
};

TEST(Pace, CanBeStoppedInAPause) {
  const auto source = pace(std::make_unique<LongPause>());
  ASSERT_TRUE(source->next());
  std::thread user([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    source->stop();
  });
  EXPECT_FALSE(source->next());
  user.join();
}

TEST(LiveInput, OnlyFilesAreRepeated) {
  for (const char* const input : {"63", "/dev/video63", "rtsp://127.0.0.1:9/x"}) {
    EXPECT_NE(error_of(ErrorKind::usage, [&] { open_live_input(input, {}, true); }).find("not a file"),
              std::string::npos);
  }
}

TEST(MonotonicClock, NeverDecreasesAndReachesItsTarget) {
  const Clock clock = monotonic_clock();
  const double before = clock.now();
  clock.wait_until(before + 0.002);
  EXPECT_GE(clock.now(), before + 0.002);
  clock.wait_until(before);  // already past
}

}  // namespace
}  // namespace telemime
