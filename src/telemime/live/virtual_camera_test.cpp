// SPDX-License-Identifier: Apache-2.0
#include "telemime/live/virtual_camera.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/videodev2.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <opencv2/imgproc.hpp>

#include "telemime/core/scratch_folder.h"
#include "telemime/core/testing_errors.h"
#include "telemime/outputs/testing_motion.h"
#include "telemime/streaming/testing_receivers.h"

namespace telemime {
namespace {

using testing_receivers::comes_true;

const cv::Scalar kGrey(96, 128, 160);
const std::atomic<bool> kGoOn = false;

/// A device of v4l2loopback, as far as its documents and those of V4L2 describe it.
struct FakeDevice {
  std::mutex mutex;
  unsigned capabilities = V4L2_CAP_VIDEO_OUTPUT | V4L2_CAP_READWRITE;
  cv::Size fixed;  ///< not empty: a reader holds this size
  bool there = true;
  int opened = 0;
  std::vector<cv::Size> formats;
  std::vector<std::string> pictures;

  VideoCalls calls() {
    return {[this](const char*) {
              const std::lock_guard lock(mutex);
              errno = ENOENT;
              opened += there ? 1 : 0;
              return there ? ::open("/dev/null", O_RDWR | O_CLOEXEC) : -1;
            },
            [](int) { return true; },
            [this](int, unsigned long request, void* argument) {
              const std::lock_guard lock(mutex);
              if (request == VIDIOC_QUERYCAP) {
                auto* facts = static_cast<v4l2_capability*>(argument);
                facts->capabilities = V4L2_CAP_DEVICE_CAPS;
                facts->device_caps = capabilities;
              } else if (request == VIDIOC_S_FMT) {
                auto& pix = static_cast<v4l2_format*>(argument)->fmt.pix;
                EXPECT_EQ(static_cast<v4l2_format*>(argument)->type, V4L2_BUF_TYPE_VIDEO_OUTPUT);
                EXPECT_EQ(pix.pixelformat, V4L2_PIX_FMT_YUYV);
                EXPECT_EQ(pix.sizeimage, 2 * pix.width * pix.height);
                if (!fixed.empty()) {
                  pix.width = static_cast<unsigned>(fixed.width);
                  pix.height = static_cast<unsigned>(fixed.height);
                }
                formats.emplace_back(static_cast<int>(pix.width), static_cast<int>(pix.height));
              } else {
                errno = ENOTTY;
                return -1;
              }
              return 0;
            },
            [this](int, const void* bytes, std::size_t size) {
              const std::lock_guard lock(mutex);
              if (!there) {
                errno = ENODEV;
                return ssize_t{-1};
              }
              pictures.emplace_back(static_cast<const char*>(bytes), size);
              return static_cast<ssize_t>(size);
            }};
  }
  std::size_t count() {
    const std::lock_guard lock(mutex);
    return pictures.size();
  }
};

cv::Mat bgr_of(const std::string& yuyv, cv::Size size) {
  EXPECT_EQ(yuyv.size(), 2U * static_cast<std::size_t>(size.area()));
  const cv::Mat raw(size, CV_8UC2, const_cast<char*>(yuyv.data()));
  cv::Mat bgr;
  cv::cvtColor(raw, bgr, cv::COLOR_YUV2BGR_YUYV);
  return bgr;
}

std::string words_of(const std::function<void()>& act) {
  return error_of(ErrorKind::output, act);
}

TEST(Yuyv, DecodesToTheSameColours) {
  Random random(3);
  cv::Mat picture(2, 64, CV_8UC3);
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < picture.cols; x += 2) {  // pairs of equal pixels lose nothing but roundings
      cv::Vec3b colour;
      for (int c = 0; c < 3; ++c) {
        colour[c] = static_cast<std::uint8_t>(random.uniform(0.0, 255.9));
      }
      picture.at<cv::Vec3b>(y, x) = picture.at<cv::Vec3b>(y, x + 1) = colour;
    }
  }
  const std::vector<std::uint8_t> bytes = yuyv_of(picture);
  const cv::Mat back = bgr_of({bytes.begin(), bytes.end()}, picture.size());
  EXPECT_LE(cv::norm(back, picture, cv::NORM_INF), 4.0);
  const auto first = [](const cv::Scalar& colour) { return yuyv_of(cv::Mat(1, 2, CV_8UC3, colour)); };
  EXPECT_EQ(first({255, 255, 255}), (std::vector<std::uint8_t>{235, 128, 235, 128}));
  EXPECT_EQ(first({0, 0, 0}), (std::vector<std::uint8_t>{16, 128, 16, 128}));
  EXPECT_EQ(first({0, 0, 255}), (std::vector<std::uint8_t>{82, 90, 82, 240}))
      << "red, by the tables of BT.601";
}

TEST(VideoOutput, NamesReasonAndRemedy) {
  const ScratchFolder folder;
  EXPECT_NE(words_of([] { VideoOutput("/dev/video63").check(); }).find("modprobe v4l2loopback"),
            std::string::npos);
  EXPECT_NE(words_of([&] { VideoOutput(folder.path() / "none").check(); }).find("mkfifo"), std::string::npos);
  EXPECT_NE(words_of([] { VideoOutput("/dev/null").check(); }).find("is not a video device"),
            std::string::npos);
  EXPECT_NE(words_of([&] { VideoOutput(folder.path()).check(); }), "");
  FakeDevice webcam;
  webcam.capabilities = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_READWRITE;
  EXPECT_NE(words_of([&] { VideoOutput("/dev/video0", webcam.calls()).check(); }).find("it is a camera"),
            std::string::npos);
  FakeDevice loopback;
  EXPECT_EQ(words_of([&] { VideoOutput("/dev/video9", loopback.calls()).check(); }), "");
}

TEST(VideoOutput, CheckLeavesTheReaderOfAFifoAlone) {
  const ScratchFolder folder;
  const std::filesystem::path fifo = folder.path() / "camera";
  ASSERT_EQ(::mkfifo(fifo.c_str(), 0600), 0);
  pollfd reader{::open(fifo.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC), POLLIN, 0};
  VideoOutput(fifo).check();
  EXPECT_EQ(::poll(&reader, 1, 0), 0) << "no end of the pictures";
  ::close(reader.fd);
}

TEST(VideoOutput, CheckLeavesNothingOfAnEarlierRun) {
  const ScratchFolder folder;
  const std::string file = folder.file("pictures");
  std::ofstream(file) << "longer than one small picture";
  VideoOutput output(file);
  output.check();
  output.write(cv::Mat(2, 2, CV_8UC3, kGrey), kGoOn);
  output.close();
  EXPECT_EQ(std::filesystem::file_size(file), 8U);
}

TEST(VideoOutput, DeviceGetsItsFormatOnceForEachSize) {
  FakeDevice device;
  VideoOutput output("/dev/video9", device.calls());
  for (const cv::Size size : {cv::Size(64, 48), cv::Size(64, 48), cv::Size(33, 21)}) {
    output.write(cv::Mat(size, CV_8UC3, kGrey), kGoOn);
  }
  EXPECT_EQ(device.formats, (std::vector<cv::Size>{{64, 48}, {32, 20}})) << "sizes are even";
  EXPECT_EQ(device.opened, 1);
  ASSERT_EQ(device.pictures.size(), 3U);
  EXPECT_LE(cv::norm(bgr_of(device.pictures[0], {64, 48}), cv::Mat(48, 64, CV_8UC3, kGrey), cv::NORM_INF), 3);
}

TEST(VideoOutput, PictureFitsADeviceOfAnotherSize) {
  FakeDevice device;
  device.fixed = {64, 48};
  VideoOutput output("/dev/video9", device.calls());
  output.write(cv::Mat(100, 400, CV_8UC3, cv::Scalar::all(255)), kGoOn);
  const cv::Mat got = bgr_of(device.pictures.at(0), {64, 48});
  EXPECT_LT(got.at<cv::Vec3b>(2, 30)[0], 10) << "a black bar";
  EXPECT_GT(got.at<cv::Vec3b>(24, 2)[0], 245);
}

class ShownBody : public ::testing::Test {
 protected:
  std::unique_ptr<VirtualCamera> open(const std::filesystem::path& path, const VideoCalls& calls) {
    return std::make_unique<VirtualCamera>(
        std::make_unique<VideoOutput>(path, calls),
        [this](MessageLevel, const std::string& words) {
          const std::lock_guard lock(mutex_);
          messages_.push_back(words);
        },
        std::chrono::milliseconds(20));
  }
  Frame frame(std::int64_t index) const {
    Frame frame;
    frame.image = cv::Mat(header_.camera.height, header_.camera.width, CV_8UC3, kGrey);
    frame.index = index;
    return frame;
  }
  MotionFrame motion(std::int64_t index) const {
    return testing_motion::frame_of(header_.body, header_.camera, Pose(), index, header_.fps);
  }
  cv::Size size() const { return {header_.camera.width, header_.camera.height}; }
  /// Pixels that differ from the picture of frame().
  int drawn(const std::string& yuyv) const {
    cv::Mat differs;
    cv::absdiff(bgr_of(yuyv, size()), frame(0).image, differs);
    return cv::countNonZero(differs.reshape(1) > 24);
  }
  std::vector<std::string> messages() {
    const std::lock_guard lock(mutex_);
    return messages_;
  }

  StreamHeader header_ = testing_motion::header();
  FakeDevice device_;
  std::mutex mutex_;
  std::vector<std::string> messages_;
};

TEST_F(ShownBody, BodyIsDrawnOnThePictureOfItsFrame) {
  const auto camera = open("/dev/video9", device_.calls());
  camera->person(header_);
  camera->picture(frame(0));
  camera->picture(frame(1));
  camera->motion(motion(1));  // frame 0 is not shown any more
  ASSERT_TRUE(comes_true([&] { return device_.count() == 1; }));
  EXPECT_GT(drawn(device_.pictures[0]), 200);
  camera->picture(frame(2));
  MotionFrame lost = motion(2);
  lost.state = TrackState::lost;
  camera->motion(lost);
  ASSERT_TRUE(comes_true([&] { return device_.count() == 2; }));
  EXPECT_EQ(drawn(device_.pictures[1]), 0) << "nobody is tracked: the picture as it is";
  camera->motion(motion(1));
  camera->motion(motion(7));
  EXPECT_EQ(messages(), std::vector<std::string>());
}

TEST_F(ShownBody, BodyIsDrawnOnAPictureOfOddSize) {
  const cv::Size even = size() / 2 * 2;
  header_.camera = header_.camera.scaled_to(even.width + 1, even.height + 1);
  const auto camera = open("/dev/video9", device_.calls());
  camera->person(header_);
  camera->picture(frame(0));
  camera->motion(motion(0));
  ASSERT_TRUE(comes_true([&] { return device_.count() == 1; }));
  EXPECT_EQ(device_.formats.at(0), even);
  EXPECT_EQ(messages(), std::vector<std::string>());
}

TEST_F(ShownBody, PicturesWithoutMotionAreShown) {
  const auto camera = open("/dev/video9", device_.calls());
  for (int i = 0; i < 4; ++i) {
    camera->picture(frame(i));
  }
  ASSERT_TRUE(comes_true([&] { return device_.count() == 1; })) << "nobody is calibrated yet";
  EXPECT_EQ(drawn(device_.pictures[0]), 0);
}

TEST_F(ShownBody, DeviceThatGoesAwayIsReportedAndFoundAgain) {
  const auto camera = open("/dev/video9", device_.calls());
  int index = 0;
  const auto until = [&](const std::function<bool()>& reached) {
    return comes_true([&] {
      camera->picture(frame(index++));
      return reached();
    });
  };
  EXPECT_TRUE(until([&] { return device_.count() > 0; }));
  {
    const std::lock_guard lock(device_.mutex);
    device_.there = false;
  }
  EXPECT_TRUE(until([&] { return !messages().empty(); }));
  EXPECT_TRUE(until([&] { return index > 100; }));
  EXPECT_EQ(messages().size(), 1U) << "once";
  {
    const std::lock_guard lock(device_.mutex);
    device_.there = true;
  }
  EXPECT_TRUE(until([&] { return messages().size() == 2; }));
  EXPECT_NE(messages()[1].find("works again"), std::string::npos);
}

TEST_F(ShownBody, FifoGetsWholePicturesAndNobodyWaitsForItsReader) {
  const ScratchFolder folder;
  const std::filesystem::path fifo = folder.path() / "camera";
  ASSERT_EQ(::mkfifo(fifo.c_str(), 0600), 0);
  {
    const auto camera = open(fifo, system_video_calls());
    for (int i = 0; i < 50; ++i) {
      camera->picture(frame(i));  // nobody reads: no call waits, nor does the end
    }
  }
  EXPECT_EQ(messages(), std::vector<std::string>());
  const auto camera = open(fifo, system_video_calls());
  const int file = ::open(fifo.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  ASSERT_GE(file, 0);
  const auto one = 2 * static_cast<std::size_t>(size().area());
  std::string bytes;
  int index = 0;
  EXPECT_TRUE(comes_true([&] {
    camera->picture(frame(index++));
    std::string part(1 << 16, '\0');
    const ssize_t count = ::read(file, part.data(), part.size());
    bytes.append(part, 0, static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
    return bytes.size() >= 2 * one;
  }));
  ::close(file);
  for (const std::size_t start : {std::size_t{0}, one}) {
    EXPECT_EQ(drawn(bytes.substr(start, one)), 0);
  }
}

TEST(NoVirtualCamera, DoesNothing) {
  VirtualCamera camera(nullptr, {});
  camera.picture({});
  camera.person(testing_motion::header());
  camera.motion({});
}

}  // namespace
}  // namespace telemime
