// SPDX-License-Identifier: Apache-2.0
#include "telemime/capture/live.h"

#include <gtest/gtest.h>

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <opencv2/core.hpp>
#include <stdexcept>
#include <vector>

#include "telemime/capture/testing.h"

namespace telemime {
namespace {

/// A camera driven by the test: the reader's thread waits in grab() until images are pushed or the end
/// is reached.
class FakeCamera {
 public:
  /// Delivers `count` images and returns when the reader has taken all and asks for another.
  void push(int count) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return failures_ == 0; });  // requested failures come first
    pending_ += count;
    changed_.notify_all();
    changed_.wait(lock, [this] { return pending_ == 0 && waiting_; });
  }
  /// Makes the next `count` reads fail, as with an unplugged cable.
  void fail(int count) {
    const std::lock_guard lock(mutex_);
    failures_ += count;
    changed_.notify_all();
  }
  LiveDevice device(double fps) {
    return {[this] { return grab(); },
            [this](cv::Mat& picture) {
              picture = testing::numbered_picture(made_++);
              return true;
            },
            {},
            fps};
  }

 private:
  bool grab() {
    std::unique_lock lock(mutex_);
    waiting_ = pending_ == 0;
    changed_.notify_all();
    changed_.wait(lock, [this] { return pending_ > 0 || failures_ > 0; });
    waiting_ = false;
    if (pending_ == 0) {
      --failures_;
      changed_.notify_all();
      return false;
    }
    --pending_;
    return true;
  }
  std::mutex mutex_;
  std::condition_variable changed_;
  int pending_ = 1;  // the image that gives the size
  int failures_ = 0;
  int made_ = 0;
  bool waiting_ = false;
};

LiveOptions with_pauses(std::vector<double> pauses) {
  LiveOptions options;
  options.pauses = std::move(pauses);
  return options;
}

/// Advances by one second with each reading.
Clock counting_clock(std::atomic<int>& looks) {
  return {[&looks] { return static_cast<double>(looks++); }, [](double) {}};
}

TEST(Live, KeepsOnlyTheNewestFrame) {
  FakeCamera camera;
  std::atomic<int> looks = 0;
  LiveOptions options = with_pauses({});
  options.clock = counting_clock(looks);
  const std::unique_ptr<Source> source = live_source(
      "0", [&] { return camera.device(30.0); }, options);
  ASSERT_TRUE(source);
  EXPECT_TRUE(source->info().live);
  EXPECT_EQ(source->info().width, 64);
  EXPECT_EQ(source->info().fps, 30.0);
  EXPECT_EQ(source->info().frames, 0);
  camera.push(4);
  const std::optional<Frame> newest = source->next();
  ASSERT_TRUE(newest);
  EXPECT_EQ(newest->index, 4);  // 0 to 3 were never requested
  EXPECT_EQ(testing::number_of(newest->image), 4);
  camera.push(2);
  const std::optional<Frame> later = source->next();
  ASSERT_TRUE(later);
  EXPECT_EQ(later->index, 6);
  EXPECT_GT(later->time, newest->time);
  EXPECT_EQ(testing::number_of(newest->image), 4);  // a returned frame never changes
  EXPECT_EQ(source->complaint(), "");
  camera.fail(1);  // releases the reader's thread
}

TEST(Live, ReturnsTheLastFrameBeforeTheEnd) {
  FakeCamera camera;
  const std::unique_ptr<Source> source = live_source(
      "0", [&] { return camera.device(30.0); }, with_pauses({}));
  camera.push(1);
  camera.fail(1);
  EXPECT_EQ(source->next()->index, 1);
  EXPECT_FALSE(source->next());
  EXPECT_FALSE(source->next());
  EXPECT_NE(source->complaint().find("did not come back in 0 attempts"), std::string::npos)
      << source->complaint();
}

TEST(Live, ReopensAStoppedDevice) {
  FakeCamera camera;
  std::atomic<int> openings = 0;
  const auto open = [&] {
    const int opening = openings++;
    // The second and third attempts find no device.
    return opening == 1 || opening == 2 ? LiveDevice{} : camera.device(0.0);
  };
  const std::unique_ptr<Source> source = live_source("0", open, with_pauses({0.0, 0.0, 0.0, 0.0}));
  EXPECT_EQ(source->info().fps, 25.0);
  EXPECT_EQ(source->next()->index, 0);
  camera.fail(1);
  camera.push(1);
  EXPECT_EQ(source->next()->index, 1);
  EXPECT_EQ(openings, 4);
  EXPECT_NE(source->complaint().find("opened again"), std::string::npos) << source->complaint();
  camera.fail(5);  // four attempts that open but deliver no image; then the source ends
  EXPECT_FALSE(source->next());
  EXPECT_EQ(source->complaint().find("opened again"), std::string::npos) << source->complaint();
  EXPECT_NE(source->complaint().find("did not come back in 4 attempts"), std::string::npos)
      << source->complaint();
}

TEST(Live, TheDefaultPausesGrow) {
  const std::vector<double> pauses = LiveOptions{}.pauses;
  ASSERT_GE(pauses.size(), 5U);
  for (std::size_t i = 1; i < pauses.size(); ++i) {
    EXPECT_GT(pauses[i], pauses[i - 1]);
  }
}

TEST(Live, CanBeDestroyedDuringAPause) {
  FakeCamera camera;
  camera.fail(1);
  std::unique_ptr<Source> source = live_source(
      "0", [&] { return camera.device(30.0); }, with_pauses({1e6}));
  ASSERT_TRUE(source);
  source.reset();  // would take twelve days if the pause did not end early
}

TEST(Live, IsNullWithoutDeviceOrImage) {
  EXPECT_FALSE(live_source("0", [] { return LiveDevice{}; }));
  EXPECT_FALSE(live_source("0", [] { return LiveDevice{[] { return false; }, {}, {}, 30.0}; }));
}

TEST(Live, DropsDamagedImages) {
  std::atomic<int> opened = 0;
  const auto open = [&opened] {
    ++opened;
    int count = 0;
    return LiveDevice{[] { return true; },
                      [&opened, count](cv::Mat& picture) mutable {
                        ++count;
                        if (opened == 1 && count > 1) {
                          CV_Error(cv::Error::StsError, "no such JPEG");  // like a failing decoder
                        }
                        picture = testing::numbered_picture(count % 7 == 3 ? 1 : 2);
                        if (opened > 1 && count % 7 == 3) {
                          CV_Error(cv::Error::StsError, "no such JPEG");
                        }
                        return true;
                      },
                      {},
                      25.0};
  };
  LiveOptions options;
  options.pauses = {0.0};
  const auto source = live_source("camera", open, options);
  ASSERT_TRUE(source);
  for (int i = 0; i < 30; ++i) {
    ASSERT_TRUE(source->next()) << i;
  }
  EXPECT_EQ(opened, 2) << "opened again after nothing but damage, and not for one picture";
  EXPECT_NE(source->complaint().find("damaged"), std::string::npos);
}

/// The index of the last frame.
std::int64_t last_of(Source& source) {
  std::int64_t last = -1;
  while (const std::optional<Frame> frame = source.next()) {
    last = frame->index;
  }
  return last;
}

TEST(Live, ReopensADriverThatThrows) {
  const auto complain = []() -> bool { CV_Error(cv::Error::StsError, "VIDIOC_DQBUF"); };
  std::atomic<int> openings = 0;
  const auto open = [&]() -> LiveDevice {
    switch (openings++) {
      case 0:
        return testing::device_of(1, complain);
      case 1:
        CV_Error(cv::Error::StsError, "cannot be opened");
      case 2:
        return testing::device_of(1, [] { return false; });
      default:
        return {};
    }
  };
  const auto source = live_source("0", open, with_pauses({0.0, 0.0, 0.0}));
  ASSERT_TRUE(source);
  EXPECT_EQ(last_of(*source), 1);
  EXPECT_GE(openings, 3);
}

TEST(Live, OtherFailuresEndWithAMessage) {
  const auto open = [] {
    return testing::device_of(3, []() -> bool { throw std::runtime_error("no driver any more"); });
  };
  const auto source = live_source("0", open, with_pauses({0.0, 0.0, 0.0}));
  ASSERT_TRUE(source);
  EXPECT_EQ(last_of(*source), 2);
  EXPECT_NE(source->complaint().find("no driver any more"), std::string::npos) << source->complaint();
}

TEST(Live, HangingDeviceIsAskedOnce) {
  std::atomic<double> now = 0.0;
  LiveOptions options = with_pauses({});
  options.clock = {[&] { return now.load(); }, [](double) {}};
  int grabs = 0;
  const auto open = [&] {
    return testing::device_of(0, [&] {
      now = now + 9.0;
      ++grabs;
      return false;
    });
  };
  EXPECT_FALSE(live_source("0", open, options));
  EXPECT_EQ(grabs, 1);
}

TEST(Live, ConvertsUnusualImages) {
  std::atomic<int> reads = 0;
  const auto grab = [&] { return reads++ < 2; };
  const auto retrieve = [&](cv::Mat& picture) {
    if (reads == 1) {
      picture = cv::Mat(48, 64, CV_8UC1, cv::Scalar(50));
    } else {
      picture = cv::Mat(96, 128, CV_16UC3, cv::Scalar::all(70 * 257));
    }
    return true;
  };
  const std::unique_ptr<Source> source = live_source(
      "0",
      [&] {
        return LiveDevice{grab, retrieve, {}, 30.0};
      },
      with_pauses({}));
  std::optional<Frame> last;
  while (std::optional<Frame> frame = source->next()) {
    EXPECT_EQ(frame->image.size(), cv::Size(64, 48));
    EXPECT_EQ(frame->image.type(), CV_8UC3);
    last = frame;
  }
  EXPECT_EQ(testing::number_of(last->image), 3);
  EXPECT_NE(source->complaint().find("resized"), std::string::npos) << source->complaint();
}

}  // namespace
}  // namespace telemime
