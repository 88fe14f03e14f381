// SPDX-License-Identifier: Apache-2.0
// Attended live sources and their time stamps.
#include <gtest/gtest.h>

#include <atomic>
#include <condition_variable>
#include <future>
#include <limits>
#include <mutex>
#include <opencv2/core.hpp>
#include <vector>

#include "telemime/capture/live.h"
#include "telemime/capture/testing.h"

namespace telemime {
namespace {

using Kind = SourceNews::Kind;

bool whole_picture(cv::Mat& picture) {
  picture = testing::numbered_picture(1);
  return true;
}

LiveOptions quick() {
  LiveOptions options;
  options.pauses = {0.0};
  options.silence = 0.01;
  return options;
}

struct Reports {
  std::function<void(const SourceNews&)> listener() {
    return [this](const SourceNews& news) { all.push_back(news); };
  }
  bool contain(Kind kind, const std::string& words) const {
    return std::any_of(all.begin(), all.end(), [&](const SourceNews& n) {
      return n.kind == kind && n.words.find(words) != std::string::npos;
    });
  }
  std::vector<SourceNews> all;
};

TEST(LiveAttended, RetriesAMissingCameraForEver) {
  constexpr int kAttempts = 300;
  std::atomic<int> openings = 0;
  std::promise<void> attended;
  const auto open = [&openings, begun = attended.get_future().share()]() -> LiveDevice {
    const int opening = openings++;
    if (opening > 0 && opening < kAttempts) {
      return {};
    }
    // The first connection delivers one image, the last one many.
    return testing::device_of(opening == 0 ? 1 : 1000000, [begun] {
      begun.wait();
      return false;
    });
  };
  Reports reports;
  const auto source = live_source("0", open, quick());
  source->attend(reports.listener());
  attended.set_value();
  EXPECT_EQ(source->next()->index, 0);
  ASSERT_TRUE(source->next());
  EXPECT_EQ(openings, kAttempts + 1);
  EXPECT_TRUE(reports.contain(Kind::worse, "stopped"));
  EXPECT_TRUE(reports.contain(Kind::better, "is back"));
}

TEST(LiveAttended, PausesAreNeverLongerThanRequested) {
  std::atomic<int> openings = 0;
  const auto open = [&openings] { return openings++ % 2 == 1 ? LiveDevice{} : testing::device_of(1); };
  LiveOptions options = quick();
  options.pauses = {1e6};
  options.longest_pause = 0.0;
  Reports reports;
  const auto source = live_source("0", open, options);
  source->attend(reports.listener());
  for (int i = 0; i < 10; ++i) {
    ASSERT_TRUE(source->next());
  }
}

TEST(LiveAttended, StopsDuringALongPause) {
  std::atomic<int> openings = 0;
  const auto open = [&openings] { return openings++ > 0 ? LiveDevice{} : testing::device_of(1); };
  LiveOptions options = quick();
  options.pauses = {1e6};
  options.longest_pause = 1e6;
  options.farewell = 60.0;
  bool left_behind = false;
  options.left_behind = [&left_behind] { left_behind = true; };
  std::promise<void> gone;
  auto source = live_source("0", open, options);
  source->attend([&gone](const SourceNews& news) {
    if (news.kind == Kind::gone) {
      gone.set_value();
    }
  });
  EXPECT_TRUE(source->next());
  auto next = std::async(std::launch::async, [&] { return source->next(); });
  gone.get_future().wait();
  source->stop();
  EXPECT_FALSE(next.get());
  source.reset();
  EXPECT_FALSE(left_behind);
}

// A driver that does not answer until the test releases it.
struct Hanging {
  std::mutex mutex;
  std::condition_variable changed;
  bool hangs = false;
  bool let_go = false;
  bool gone = false;
};

TEST(LiveAttended, HangingDeviceDelaysNobody) {
  const auto hanging = std::make_shared<Hanging>();
  const auto open = [hanging] {
    return testing::device_of(1, [hanging] {
      std::unique_lock lock(hanging->mutex);
      hanging->hangs = true;
      hanging->changed.notify_all();
      hanging->changed.wait(lock, [&] { return hanging->let_go; });
      hanging->gone = true;
      hanging->changed.notify_all();
      return false;
    });
  };
  LiveOptions options = quick();
  options.farewell = 0.01;
  bool left_behind = false;
  options.left_behind = [&left_behind] { left_behind = true; };
  auto source = live_source("0", open, options);
  std::unique_lock lock(hanging->mutex);
  hanging->changed.wait(lock, [&] { return hanging->hangs; });
  lock.unlock();
  source.reset();  // would wait for ever
  EXPECT_TRUE(left_behind) << "whoever ends the program must know";
  lock.lock();
  EXPECT_FALSE(hanging->gone);
  hanging->let_go = true;
  hanging->changed.notify_all();
  hanging->changed.wait(lock, [&] { return hanging->gone; });
}

TEST(LiveAttended, ReportsSilenceAndItsEnd) {
  std::promise<void> go_on;
  const auto open = [waited = go_on.get_future().share()] {
    return testing::device_of(1, [waited] {
      waited.wait();
      return true;
    });
  };
  Reports reports;
  const auto source = live_source("0", open, quick());
  source->attend([&](const SourceNews& news) {
    reports.all.push_back(news);
    if (news.kind == Kind::gone) {
      go_on.set_value();
    }
  });
  EXPECT_TRUE(source->next());
  EXPECT_TRUE(source->next());
  EXPECT_TRUE(reports.contain(Kind::gone, "no images"));
  EXPECT_TRUE(reports.contain(Kind::better, "is back"));
}

TEST(LiveAttended, ReportsDamageAndSizes) {
  std::atomic<int> reads = 0;
  std::promise<void> attended;
  const auto open = [&reads, begun = attended.get_future().share()] {
    return LiveDevice{[&reads, begun] {
                        if (reads > 0) {
                          begun.wait();
                        }
                        return true;
                      },
                      [&reads](cv::Mat& picture) {
                        const int read = reads++;
                        picture =
                            testing::numbered_picture(1, read < 6 ? cv::Size(64, 48) : cv::Size(64, 36));
                        return read < 1 || read > 4;
                      },
                      {},
                      25.0};
  };
  Reports reports;
  const auto source = live_source("0", open, quick());
  source->attend(reports.listener());
  attended.set_value();
  while (reads < 10 || reports.all.size() < 2) {
    const auto frame = source->next();
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->image.size(), cv::Size(64, 48));
  }
  EXPECT_TRUE(reports.contain(Kind::worse, "damaged"));
  EXPECT_TRUE(reports.contain(Kind::worse, "64x36"));
}

// Frame::taken of the images after the first, if the driver gives these stamps and the clock advances by one
// second per image, starting at 100.
std::vector<double> taken_with(const std::vector<double>& stamps) {
  const auto now = std::make_shared<std::atomic<double>>(100.0);
  const auto turn = std::make_shared<std::atomic<std::size_t>>(0);
  std::mutex mutex;
  std::condition_variable changed;
  std::size_t wanted = 0;
  const auto open = [&] {
    return LiveDevice{[&, count = std::size_t{0}]() mutable {
                        std::unique_lock lock(mutex);
                        changed.wait(lock, [&] { return wanted >= count || count > stamps.size(); });
                        if (count > stamps.size()) {
                          return false;
                        }
                        *turn = count++;
                        *now = 100.0 + static_cast<double>(*turn);
                        return true;
                      },
                      whole_picture, [&, turn] { return stamps[*turn - 1]; }, 25.0};
  };
  LiveOptions options;
  options.pauses = {};
  options.clock = {[now] { return now->load(); }, [](double) {}};
  const auto source = live_source("0", open, options);
  EXPECT_EQ(source->next()->taken, 100.0);
  std::vector<double> taken;
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    {
      const std::lock_guard lock(mutex);
      wanted = i + 1;
    }
    changed.notify_all();
    const auto frame = source->next();
    taken.push_back(frame->taken);
    EXPECT_EQ(frame->time, frame->taken - 100.0);
  }
  {
    const std::lock_guard lock(mutex);
    wanted = stamps.size() + 1;
  }
  changed.notify_all();
  EXPECT_FALSE(source->next());
  return taken;
}

TEST(LiveAttended, UsesTheStampOfTheDriver) {
  EXPECT_EQ(taken_with({100.9, 101.8, 102.5}), (std::vector<double>{100.9, 101.8, 102.5}));
}

TEST(LiveAttended, IgnoresStampsOfOtherClocks) {
  constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(taken_with({0.0, 1.7e9, kNothing, -3.0}), (std::vector<double>{101.0, 102.0, 103.0, 104.0}));
}

TEST(LiveAttended, StampsNeverDecrease) {
  EXPECT_EQ(taken_with({100.9, 100.9, 100.2, 103.9}), (std::vector<double>{100.9, 102.0, 103.0, 103.9}));
}

}  // namespace
}  // namespace telemime
