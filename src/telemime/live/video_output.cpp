// SPDX-License-Identifier: Apache-2.0
#include "telemime/live/video_output.h"

#include <fcntl.h>
#include <linux/videodev2.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "telemime/core/errors.h"

namespace telemime {
namespace {

constexpr int kWait = 100;  // ms between looks at `stop`
constexpr const char* kModule =
    "A device for this is made by the kernel module v4l2loopback: sudo modprobe v4l2loopback video_nr=9 "
    "exclusive_caps=1";

// The picture in the middle, as large as it fits.
cv::Mat fitted(const cv::Mat& picture, cv::Size size) {
  if (picture.size() == size) {
    return picture;
  }
  const double scale = std::min(size.width / static_cast<double>(picture.cols),
                                size.height / static_cast<double>(picture.rows));
  const cv::Size inner(std::clamp(cvRound(scale * picture.cols), 1, size.width),
                       std::clamp(cvRound(scale * picture.rows), 1, size.height));
  cv::Mat framed(size, CV_8UC3, cv::Scalar::all(0));
  cv::resize(picture,
             framed(cv::Rect((size.width - inner.width) / 2, (size.height - inner.height) / 2, inner.width,
                             inner.height)),
             inner, 0.0, 0.0, cv::INTER_AREA);
  return framed;
}

}  // namespace

VideoCalls system_video_calls() {
  return {[](const char* path) { return ::open(path, O_RDWR | O_NONBLOCK | O_CLOEXEC); },
          [](int file) {
            struct stat facts {};
            return ::fstat(file, &facts) == 0 && S_ISCHR(facts.st_mode);
          },
          [](int file, unsigned long request, void* argument) { return ::ioctl(file, request, argument); },
          [](int file, const void* bytes, std::size_t size) { return ::write(file, bytes, size); }};
}

std::vector<std::uint8_t> yuyv_of(const cv::Mat& picture) {
  CV_Assert(picture.type() == CV_8UC3 && picture.cols % 2 == 0);
  std::vector<std::uint8_t> bytes(2 * picture.total());
  std::uint8_t* out = bytes.data();
  const auto luma = [](const std::uint8_t* p) {
    return static_cast<std::uint8_t>(16 + ((25 * p[0] + 129 * p[1] + 66 * p[2] + 128) >> 8));
  };
  for (int y = 0; y < picture.rows; ++y) {
    const std::uint8_t* in = picture.ptr(y);
    for (int x = 0; x < picture.cols; x += 2, in += 6, out += 4) {
      const int b = in[0] + in[3];  // of two pixels: hence the shift by 9
      const int g = in[1] + in[4];
      const int r = in[2] + in[5];
      out[0] = luma(in);
      out[1] = static_cast<std::uint8_t>(128 + ((112 * b - 74 * g - 38 * r + 256) >> 9));
      out[2] = luma(in + 3);
      out[3] = static_cast<std::uint8_t>(128 + ((112 * r - 94 * g - 18 * b + 256) >> 9));
    }
  }
  return bytes;
}

VideoOutput::VideoOutput(std::filesystem::path path, VideoCalls calls)
    : path_(std::move(path)), calls_(std::move(calls)) {}

VideoOutput::~VideoOutput() {
  close();
}

void VideoOutput::close() noexcept {
  if (file_ >= 0) {
    ::close(std::exchange(file_, -1));
  }
}

void VideoOutput::check() {
  std::error_code unknown;
  // A FIFO is not opened: its reader would take the end of that for the end of the pictures.
  if (!std::filesystem::is_fifo(path_, unknown) || ::access(path_.c_str(), W_OK) != 0) {
    open();
    // An existing file keeps nothing of an earlier run.
    struct stat facts {};
    if (::fstat(file_, &facts) == 0 && S_ISREG(facts.st_mode)) {
      static_cast<void>(::ftruncate(file_, 0) == 0);
    }
    close();
  }
}

void VideoOutput::open() {
  const std::string name = path_.string();
  file_ = calls_.open(path_.c_str());
  if (file_ < 0) {
    const int reason = errno;
    const bool missing = reason == ENOENT || reason == ENXIO || reason == ENODEV;
    const bool device = name.starts_with("/dev/");
    throw Error(ErrorKind::output,
                "the virtual camera " + name + " cannot be opened: " + std::strerror(reason),
                reason == EACCES  ? device ? "Your user must be in the group video."
                                           : "Give yourself the right to write to it: chmod u+w."
                : reason == EBUSY ? "Close the programs that use it."
                : device          ? kModule
                : missing         ? "Make the FIFO first (mkfifo), or name a device: /dev/video9."
                                  : "");
  }
  device_ = calls_.is_device(file_);
  if (!device_) {
    return;
  }
  v4l2_capability facts{};
  const bool video = calls_.ioctl(file_, VIDIOC_QUERYCAP, &facts) == 0;
  const auto can = (facts.capabilities & V4L2_CAP_DEVICE_CAPS) != 0 ? facts.device_caps : facts.capabilities;
  if (!video || (can & V4L2_CAP_VIDEO_OUTPUT) == 0 || (can & V4L2_CAP_READWRITE) == 0) {
    close();
    throw Error(
        ErrorKind::output,
        name + (video ? " takes no pictures: it is a camera or an encoder" : " is not a video device"),
        kModule);
  }
}

// The size that the device has then: it may be fixed by a program that reads it.
cv::Size VideoOutput::set_format(cv::Size size) {
  if (!device_) {
    return size;
  }
  v4l2_format format{};
  format.type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
  format.fmt.pix.width = static_cast<unsigned>(size.width);
  format.fmt.pix.height = static_cast<unsigned>(size.height);
  format.fmt.pix.pixelformat = V4L2_PIX_FMT_YUYV;
  format.fmt.pix.field = V4L2_FIELD_NONE;
  format.fmt.pix.colorspace = V4L2_COLORSPACE_SRGB;
  format.fmt.pix.bytesperline = 2 * format.fmt.pix.width;
  format.fmt.pix.sizeimage = format.fmt.pix.bytesperline * format.fmt.pix.height;
  if (calls_.ioctl(file_, VIDIOC_S_FMT, &format) != 0) {
    throw Error(ErrorKind::output,
                "the virtual camera " + path_.string() + " accepts no format: " + std::strerror(errno),
                "Another program may write to it.");
  }
  const cv::Size given(static_cast<int>(format.fmt.pix.width), static_cast<int>(format.fmt.pix.height));
  if (format.fmt.pix.pixelformat != V4L2_PIX_FMT_YUYV || given.width % 2 != 0 || given.area() <= 0) {
    throw Error(ErrorKind::output,
                "the virtual camera " + path_.string() + " is set to a format other than YUYV",
                "Close the programs that use it.");
  }
  return given;
}

void VideoOutput::write(const cv::Mat& picture, const std::atomic<bool>& stop) {
  try {
    if (file_ < 0) {
      open();
      asked_ = {};
    }
    const cv::Size even(picture.cols / 2 * 2, picture.rows / 2 * 2);  // as draw_overlay makes them
    if (asked_ != even) {
      size_ = set_format(even);
      asked_ = even;
    }
    const std::vector<std::uint8_t> bytes = yuyv_of(fitted(picture(cv::Rect({}, even)), size_));
    for (std::size_t done = 0; done < bytes.size();) {
      const ssize_t count = calls_.write(file_, bytes.data() + done, bytes.size() - done);
      if (count > 0) {
        done += static_cast<std::size_t>(count);
      } else if (count < 0 && errno == EAGAIN) {
        if (stop) {
          return;
        }
        pollfd room{file_, POLLOUT, 0};
        ::poll(&room, 1, kWait);
      } else if (count == 0 || errno != EINTR) {
        throw Error(ErrorKind::output, "the virtual camera " + path_.string() +
                                           " takes no more pictures: " + std::strerror(errno));
      }
    }
  } catch (...) {
    close();
    throw;
  }
}

}  // namespace telemime
