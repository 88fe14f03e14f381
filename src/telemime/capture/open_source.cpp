// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>
#include <algorithm>
#include <filesystem>
#include <opencv2/videoio.hpp>
#include <system_error>
#include <utility>
#include <vector>

#include "telemime/capture/file_check.h"
#include "telemime/capture/image_sequence.h"
#include "telemime/capture/input_kind.h"
#include "telemime/capture/live.h"
#include "telemime/capture/source.h"
#include "telemime/capture/video_file.h"

namespace telemime {
namespace {

constexpr int stream_patience = 8000;  // milliseconds to connect, and then to wait for each frame

/// Copies of a VideoCapture share the same open device.
LiveDevice as_device(const cv::VideoCapture& opened) {
  if (!opened.isOpened()) {
    return {};
  }
  const double fps = opened.get(cv::CAP_PROP_FPS);
  return {[video = opened](cv::Mat& picture) mutable { return video.read(picture); }, fps};
}

cv::VideoCapture open_stream_capture(const std::string& url) {
  cv::VideoCapture video;
  video.open(
      url, cv::CAP_FFMPEG,
      {cv::CAP_PROP_OPEN_TIMEOUT_MSEC, stream_patience, cv::CAP_PROP_READ_TIMEOUT_MSEC, stream_patience});
  return video;
}

cv::VideoCapture open_camera_capture(const std::string& device) {
  cv::VideoCapture video(device, cv::CAP_V4L2);
  if (video.isOpened()) {
    video.set(cv::CAP_PROP_BUFFERSIZE, 1);  // old frames in the driver's queue are only delay
  }
  return video;
}

std::string cameras_found() {
  std::vector<std::string> names;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator("/dev", ignored)) {
    if (entry.path().filename().string().starts_with("video")) {
      names.push_back(entry.path().string());
    }
  }
  std::sort(names.begin(), names.end());
  std::string all;
  for (const std::string& name : names) {
    all += (all.empty() ? "" : ", ") + name;
  }
  return all.empty()
             ? "No camera is connected, or none is visible here (a container or a virtual machine must be "
               "given one)."
             : "Devices found: " + all + ". Not all of them give pictures.";
}

std::unique_ptr<Source> open_camera(const std::string& input, InputKind kind) {
  const std::string device = kind == InputKind::camera ? "/dev/video" + input : input;
  std::error_code ignored;
  if (!std::filesystem::exists(device, ignored)) {
    throw cannot_read(input, kind, "there is no " + device, cameras_found());
  }
  if (::access(device.c_str(), R_OK | W_OK) != 0) {
    throw cannot_read(
        input, kind, "no right to use " + device,
        "Add yourself to the group that owns it (sudo adduser $USER video), then log in again.");
  }
  std::unique_ptr<Source> source =
      live_source(input, [device] { return as_device(open_camera_capture(device)); });
  if (!source) {
    throw cannot_read(input, kind, device + " gives no pictures",
                      "Close other programs that use the camera. " + cameras_found());
  }
  return source;
}

std::unique_ptr<Source> open_stream(const std::string& url) {
  const std::string remedy = "Check the address and that the sender runs; 'ffplay URL' should show it.";
  cv::VideoCapture video = open_stream_capture(url);
  if (!video.isOpened()) {
    throw cannot_read(url, InputKind::stream, "no connection, or no video in it", remedy);
  }
  const bool finite = url.starts_with("http") && video.get(cv::CAP_PROP_FRAME_COUNT) > 0.0;
  if (finite) {  // a file on a server: read all of it, and do not start again at its end
    return video_source(video, url, InputKind::stream);
  }
  std::unique_ptr<Source> source = live_source(url, [url, opened = video]() mutable {
    const cv::VideoCapture first_time = std::exchange(opened, {});
    return as_device(first_time.isOpened() ? first_time : open_stream_capture(url));
  });
  video = {};  // the source alone holds it now, and can close it
  if (!source) {
    throw cannot_read(url, InputKind::stream, "connected, but no picture came", remedy);
  }
  return source;
}

}  // namespace

std::unique_ptr<Source> open_source(const std::string& input) {
  if (input.empty()) {
    throw Error(ErrorKind::usage, "the name of the input is empty",
                "Give a video file, a folder of images, a stream URL or a camera (0).");
  }
  const InputKind kind = input_kind(input);
  switch (kind) {
    case InputKind::camera:
    case InputKind::device:
      return open_camera(input, kind);
    case InputKind::stream:
      return open_stream(input);
    case InputKind::folder:
    case InputKind::pattern:
    case InputKind::image:
      return open_image_sequence(input, kind);
    case InputKind::video_file:
      break;
  }
  return open_video_file(without_file_scheme(input));
}

}  // namespace telemime
