// SPDX-License-Identifier: Apache-2.0
// Faults of network cameras: a real Motion JPEG stream over HTTP, opened by its URL.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <future>
#include <opencv2/imgproc.hpp>
#include <random>

#include "live/mjpeg_server.h"
#include "telemime/capture/live.h"

namespace telemime {
namespace {

using live_testing::jpegs;
using live_testing::MjpegServer;
using Kind = SourceNews::Kind;
using Steady = std::chrono::steady_clock;

// An image whose grey level identifies its number; the dot makes the JPEG non-trivial.
cv::Mat numbered(int number, cv::Size size = {160, 120}) {
  cv::Mat made(size, CV_8UC3, cv::Scalar::all(40 + 30 * number));
  cv::circle(made, {size.width / 2, size.height / 2}, size.height / 8, {30, 60, 90}, cv::FILLED);
  return made;
}

std::vector<std::string> six(cv::Size size = {160, 120}) {
  std::vector<cv::Mat> pictures;
  for (int i = 0; i < 6; ++i) {
    pictures.push_back(numbered(i, size));
  }
  return jpegs(pictures);
}

int level(const cv::Mat& image) {
  return image.at<cv::Vec3b>(image.rows / 2, image.cols / 8)[1];
}

class Stream : public ::testing::Test {
 protected:
  explicit Stream(MjpegServer::Protocol protocol = MjpegServer::Protocol::http) : server_(protocol) {}
  // With short time-outs, so that the tests are quick.
  void open() {
    LiveOptions options;
    options.pauses = {0.01};
    options.longest_pause = 0.01;
    options.silence = 0.5;
    options.patience = 1.0;
    server_.show(six(), 100.0);
    source_ = open_source(server_.url(), options);
    source_->attend([this](const SourceNews& news) { news_.push_back(news); });
  }
  bool reported(Kind kind, const std::string& words) const {
    return std::any_of(news_.begin(), news_.end(), [&](const SourceNews& n) {
      return n.kind == kind && n.words.find(words) != std::string::npos;
    });
  }
  // Reads frames until `done(frame)`; false at the end of the source or after a minute.
  template <typename Done>
  bool read_until(const Done& done) {
    const auto deadline = Steady::now() + std::chrono::minutes(1);
    while (Steady::now() < deadline) {
      const auto frame = source_->next();
      if (!frame) {
        return false;
      }
      EXPECT_EQ(frame->image.size(), cv::Size(160, 120));
      if (done(*frame)) {
        return true;
      }
    }
    return false;
  }
  ::testing::AssertionResult read_until_reported(Kind kind, const std::string& words) {
    if (read_until([&](const Frame&) { return reported(kind, words); })) {
      return ::testing::AssertionSuccess();
    }
    auto failure = ::testing::AssertionFailure() << "\"" << words << "\" was not reported, but:";
    for (const SourceNews& news : news_) {
      failure << "\n" << news.words;
    }
    return failure;
  }

  MjpegServer server_;
  std::unique_ptr<Source> source_;
  std::vector<SourceNews> news_;
};

TEST_F(Stream, FramesAreInOrderWithLocalTime) {
  const auto seconds = [] { return std::chrono::duration<double>(Steady::now().time_since_epoch()).count(); };
  const double before = seconds();
  open();
  EXPECT_TRUE(source_->info().live);
  double last = before;
  std::int64_t index = -1;
  int count = 0;
  ASSERT_TRUE(read_until([&](const Frame& frame) {
    EXPECT_GE(frame.taken, last);
    EXPECT_GT(frame.index, index);
    last = frame.taken;
    index = frame.index;
    const int grey = level(frame.image);
    const int nearest = 40 + 30 * ((grey - 25) / 30);
    EXPECT_NEAR(grey, nearest, 4) << "none of the six images";
    return ++count == 30;
  }));
  EXPECT_LE(last, seconds());
  EXPECT_EQ(source_->complaint(), "");
}

TEST_F(Stream, ReconnectsAfterServerHangsUp) {
  open();
  for (int time = 0; time < 3; ++time) {
    ASSERT_TRUE(read_until([](const Frame&) { return true; }));
    news_.clear();
    server_.hang_up();
    ASSERT_TRUE(read_until_reported(Kind::better, "is back"));
    EXPECT_TRUE(reported(Kind::worse, "stopped"));
  }
  EXPECT_NE(source_->complaint().find("stopped 3 times"), std::string::npos) << source_->complaint();
}

TEST_F(Stream, StopsAtOnceWithoutAnswer) {
  open();
  ASSERT_TRUE(read_until([](const Frame&) { return true; }));
  server_.unplug();
  auto next = std::async(std::launch::async, [&] { return source_->next(); });
  source_->stop();
  next.wait();
  EXPECT_FALSE(source_->next());
}

TEST_F(Stream, ReportsAnotherImageSize) {
  open();
  server_.show(six({320, 240}), 100.0);
  ASSERT_TRUE(read_until_reported(Kind::worse, "320x240"));
  server_.show(jpegs({numbered(4, {320, 180})}), 100.0);
  ASSERT_TRUE(read_until_reported(Kind::worse, "another aspect ratio"));
  // The image is the camera's, complete and current, with bars.
  ASSERT_TRUE(read_until([](const Frame& f) {
    return std::abs(level(f.image) - 160) < 5 && f.image.at<cv::Vec3b>(2, 80)[1] < 5 &&
           f.image.at<cv::Vec3b>(117, 80)[1] < 5;
  }));
  server_.show(six(), 100.0);
  ASSERT_TRUE(read_until_reported(Kind::better, "160x120"));
}

TEST_F(Stream, DropsAndReportsDamagedImages) {
  open();
  auto parts = six();
  std::mt19937 random(1);
  parts[1] = std::string(5000, 'x');
  for (std::size_t i = 2; i < parts[3].size(); ++i) {
    parts[3][i] = static_cast<char>(random());
  }
  parts[4].resize(parts[4].size() / 2);
  parts[5].clear();
  server_.show(parts, 100.0);
  ASSERT_TRUE(read_until_reported(Kind::worse, "damaged"));
  int count = 0;
  ASSERT_TRUE(read_until([&](const Frame& frame) {
    const int grey = level(frame.image);
    EXPECT_TRUE(std::abs(grey - 40) < 5 || std::abs(grey - 100) < 5 || count < 6) << grey;
    return ++count == 50;
  }));
  server_.show(six(), 100.0);
  ASSERT_TRUE(read_until_reported(Kind::better, "no longer damaged"));
  EXPECT_NE(source_->complaint().find("damaged images were dropped"), std::string::npos);
}

class EveryStream : public Stream, public ::testing::WithParamInterface<MjpegServer::Protocol> {
 protected:
  EveryStream() : Stream(GetParam()) {}
};

INSTANTIATE_TEST_SUITE_P(Protocols, EveryStream,
                         ::testing::Values(MjpegServer::Protocol::http, MjpegServer::Protocol::rtsp));

TEST_P(EveryStream, EachStallIsToldOnce) {
  open();
  ASSERT_TRUE(read_until([](const Frame&) { return true; }));
  for (int stall = 1; stall <= 2; ++stall) {
    news_.clear();
    // Silent while the source connects three times more.
    const int connections = server_.connections();
    server_.fall_silent();
    auto resumed = std::async(std::launch::async, [&] {
      server_.wait_for_connection(connections + 3);
      server_.show(six(), 100.0);
    });
    ASSERT_TRUE(read_until_reported(Kind::better, "is back"));
    const auto told = [&](Kind kind) {
      return std::count_if(news_.begin(), news_.end(), [&](const auto& n) { return n.kind == kind; });
    };
    EXPECT_EQ(told(Kind::gone), 1) << stall;
    EXPECT_TRUE(reported(Kind::gone, "no images")) << stall;
    EXPECT_EQ(told(Kind::better), 1) << stall;
    ASSERT_TRUE(read_until([](const Frame& f) { return level(f.image) > 0; })) << "images go on";
  }
}

TEST_P(EveryStream, ComesBackAfterHangingUp) {
  open();
  for (int time = 0; time < 2; ++time) {
    ASSERT_TRUE(read_until([](const Frame&) { return true; }));
    news_.clear();
    server_.hang_up();
    ASSERT_TRUE(read_until_reported(Kind::better, "is back"));
  }
}

}  // namespace
}  // namespace telemime
