// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <linux/videodev2.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <string>
#include <system_error>

#include "telemime/capture/cameras.h"

namespace telemime {
namespace {

// Sizes that are asked for where a camera can do any.
constexpr std::pair<unsigned, unsigned> kSizes[] = {{640, 480}, {640, 360}, {1280, 720}, {1920, 1080}};

// Calls again when a signal interrupts.
bool control(int device, unsigned long request, void* argument) {
  int result = -1;
  do {
    result = ::ioctl(device, request, argument);
  } while (result == -1 && errno == EINTR);
  return result == 0;
}

std::string four_characters(std::uint32_t format) {
  std::string text;
  for (int shift = 0; shift < 32; shift += 8) {
    text.push_back(static_cast<char>((format >> static_cast<unsigned>(shift)) & 0x7fU));
  }
  return text;
}

double rate_by_interval(const v4l2_fract& interval) {
  return interval.numerator == 0 ? 0.0 : static_cast<double>(interval.denominator) / interval.numerator;
}

// The highest rate of a format and size.
double highest_rate(int device, std::uint32_t format, unsigned width, unsigned height) {
  double highest = 0.0;
  v4l2_frmivalenum interval{};
  interval.pixel_format = format;
  interval.width = width;
  interval.height = height;
  for (; control(device, VIDIOC_ENUM_FRAMEINTERVALS, &interval); ++interval.index) {
    const bool listed = interval.type == V4L2_FRMIVAL_TYPE_DISCRETE;
    highest = std::max(highest, rate_by_interval(listed ? interval.discrete : interval.stepwise.min));
    if (!listed) {
      break;
    }
  }
  return highest;
}

void add_sizes(int device, std::uint32_t format, std::vector<CameraMode>& modes) {
  const auto add = [&](unsigned width, unsigned height) {
    modes.push_back({four_characters(format), static_cast<int>(width), static_cast<int>(height),
                     highest_rate(device, format, width, height)});
  };
  const std::size_t before = modes.size();
  v4l2_frmsizeenum size{};
  size.pixel_format = format;
  for (; control(device, VIDIOC_ENUM_FRAMESIZES, &size); ++size.index) {
    if (size.type == V4L2_FRMSIZE_TYPE_DISCRETE) {
      add(size.discrete.width, size.discrete.height);
      continue;
    }
    const v4l2_frmsize_stepwise& range = size.stepwise;
    for (const auto& [width, height] : kSizes) {
      if (width >= range.min_width && width <= range.max_width && height >= range.min_height &&
          height <= range.max_height) {
        add(width, height);
      }
    }
    break;
  }
  // Drivers that list no sizes, or none of these, give the nearest to what is asked for.
  if (modes.size() == before) {
    add(kSizes[0].first, kSizes[0].second);
  }
}

}  // namespace

void ask_v4l2(CameraInfo& camera) {
  const int device = ::open(camera.device.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  if (device == -1) {
    camera.problem = errno == EACCES ? "no permission" : std::generic_category().message(errno);
    return;
  }
  v4l2_capability about{};
  if (!control(device, VIDIOC_QUERYCAP, &about)) {
    camera.problem = "it does not answer as a video device";
    ::close(device);
    return;
  }
  const std::uint32_t can =
      (about.capabilities & V4L2_CAP_DEVICE_CAPS) != 0U ? about.device_caps : about.capabilities;
  const bool images = (can & (V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_VIDEO_CAPTURE_MPLANE)) != 0U;
  camera.kind = images                                ? CameraKind::camera
                : (can & V4L2_CAP_META_CAPTURE) != 0U ? CameraKind::metadata
                                                      : CameraKind::no_camera;
  if (camera.name.empty()) {
    camera.name = reinterpret_cast<const char*>(about.card);
  }
  v4l2_fmtdesc format{};
  format.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  for (; images && control(device, VIDIOC_ENUM_FMT, &format); ++format.index) {
    add_sizes(device, format.pixelformat, camera.modes);
  }
  ::close(device);
}

}  // namespace telemime
