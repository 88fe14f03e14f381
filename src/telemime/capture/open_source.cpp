// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>
#include <algorithm>
#include <filesystem>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <system_error>
#include <utility>
#include <vector>

#include "telemime/capture/cameras.h"
#include "telemime/capture/changed_images.h"
#include "telemime/capture/image_sequence.h"
#include "telemime/capture/input_kind.h"
#include "telemime/capture/live.h"
#include "telemime/capture/source.h"
#include "telemime/capture/stream.h"
#include "telemime/capture/video_file.h"

namespace telemime {
namespace {

// A higher rate costs light and processor time.
constexpr double kMostRate = 30.0;  // frames per second

/// Copies of a VideoCapture share the same open device.
LiveDevice camera_device(const std::string& device) {
  cv::VideoCapture video(device, cv::CAP_V4L2);
  if (!video.isOpened()) {
    return {};
  }
  CameraInfo info{.device = device};
  ask_v4l2(info);
  if (const auto mode = best_mode(info.modes)) {
    const std::string& f = mode->format;
    video.set(cv::CAP_PROP_FOURCC, cv::VideoWriter::fourcc(f[0], f[1], f[2], f[3]));
    video.set(cv::CAP_PROP_FRAME_WIDTH, mode->width);
    video.set(cv::CAP_PROP_FRAME_HEIGHT, mode->height);
    video.set(cv::CAP_PROP_FPS, std::min(mode->fps > 0.0 ? mode->fps : kMostRate, kMostRate));
  }
  // OpenCV before 4.11 exchanges red and blue of NV12 (https://github.com/opencv/opencv/pull/26081).
  constexpr bool kExchanges = CV_VERSION_MAJOR * 100 + CV_VERSION_MINOR < 411;
  const bool exchanged = kExchanges && static_cast<int>(video.get(cv::CAP_PROP_FOURCC)) ==
                                           cv::VideoWriter::fourcc('N', 'V', '1', '2');
  return {
      [video]() mutable { return video.grab(); },
      [video, exchanged](cv::Mat& picture) mutable {
        const bool taken = video.retrieve(picture);
        if (taken && exchanged) {
          cv::cvtColor(picture, picture, cv::COLOR_RGB2BGR);
        }
        return taken;
      },
      // The driver's own stamp; of the monotonic clock with nearly all drivers (uvcvideo: its first bytes).
      [video] { return video.get(cv::CAP_PROP_POS_MSEC) / 1000.0; }, video.get(cv::CAP_PROP_FPS)};
}

std::string cameras_found(const std::vector<CameraInfo>& cameras) {
  const std::string words = in_words(cameras);
  return words.empty()
             ? "No camera is connected, or none is visible here (a container or a virtual machine must be "
               "given one)."
             : "Cameras found: " + words + ". `telemime doctor` tells more.";
}

std::unique_ptr<Source> open_camera(const std::string& input, InputKind kind, const LiveOptions& options) {
  const std::string device = kind == InputKind::camera ? "/dev/video" + input : input;
  std::error_code ignored;
  if (!std::filesystem::exists(device, ignored)) {
    const bool is_file = std::filesystem::exists(input, ignored);
    throw cannot_read(input, kind, "there is no " + device,
                      is_file ? "The file of that name is ./" + input + "." : cameras_found(list_cameras()));
  }
  if (::access(device.c_str(), R_OK | W_OK) != 0) {
    throw cannot_read(
        input, kind, "no permission to use " + device,
        "Add yourself to the group that owns it (sudo adduser $USER video), then log in again.");
  }
  const std::vector<CameraInfo> cameras = list_cameras();
  if (const std::string why = why_no_images(cameras, device); !why.empty()) {
    throw cannot_read(input, kind, why, cameras_found(cameras));
  }
  // A camera that was away may come back under another number; its link by id then leads there.
  const auto own = std::find_if(cameras.begin(), cameras.end(),
                                [&](const CameraInfo& camera) { return camera.device == device; });
  const auto now_at = [device, by_id = own == cameras.end() ? "" : own->by_id] {
    std::error_code missing;
    const std::filesystem::path found = std::filesystem::canonical(by_id, missing);
    return missing ? device : found.string();
  };
  std::unique_ptr<Source> source = live_source(
      input, [now_at] { return camera_device(now_at()); }, options);
  if (!source) {
    throw cannot_read(input, kind, device + " delivers no images",
                      "Close other programs that use the camera. " + cameras_found(cameras));
  }
  return source;
}

std::unique_ptr<Source> open_stream(const std::string& url, const LiveOptions& options) {
  const std::string remedy = "Check the address and that the sender runs; 'ffplay URL' should show it.";
  const std::string shown = shown_url(url);
  cv::VideoCapture video = connect_to_stream(url, options.patience);
  if (!video.isOpened()) {
    throw cannot_read(shown, InputKind::stream, "no connection, or no video in it", remedy);
  }
  const bool finite = url.starts_with("http") && video.get(cv::CAP_PROP_FRAME_COUNT) > 0.0;
  if (finite) {  // a file on a server: read all of it, and do not reconnect at its end
    return video_source({.video = video,
                         .name = shown,
                         .kind = InputKind::stream,
                         .stamps = first_stamps(connect_to_stream(url, options.patience))},
                        options.input);
  }
  auto open = [url, patience = options.patience, opened = video]() mutable {
    const cv::VideoCapture first_time = std::exchange(opened, {});
    return stream_device(first_time.isOpened() ? first_time : connect_to_stream(url, patience), patience);
  };
  video = {};  // now only the source holds it and can close it
  std::unique_ptr<Source> source = live_source(shown, std::move(open), options);
  if (!source) {
    throw cannot_read(shown, InputKind::stream, "connected, but no image was received", remedy);
  }
  return source;
}

cv::Mat mirror_image(const cv::Mat& image) {
  cv::Mat mirrored;
  cv::flip(image, mirrored, 1);
  return mirrored;
}

std::unique_ptr<Source> open_kind(const std::string& input, const LiveOptions& options) {
  const InputKind kind = input_kind(input);
  switch (kind) {
    case InputKind::camera:
    case InputKind::device:
      return open_camera(input, kind, options);
    case InputKind::stream:
      return open_stream(input, options);
    case InputKind::folder:
    case InputKind::pattern:
    case InputKind::image:
      return open_image_sequence(input, kind, options.input);
    case InputKind::video_file:
      break;
  }
  return open_video_file(without_file_scheme(input), options.input);
}

}  // namespace

std::unique_ptr<Source> open_source(const std::string& input, const InputOptions& options) {
  LiveOptions live;
  live.input = options;
  return open_source(input, live);
}

std::unique_ptr<Source> open_source(const std::string& input, const LiveOptions& options) {
  if (input.empty()) {
    throw Error(ErrorKind::usage, "the name of the input is empty",
                "Give a video file, a folder of images, a stream URL or a camera (0).");
  }
  auto source = open_kind(input, options);
  return options.input.mirrored ? std::make_unique<ChangedImages>(std::move(source), mirror_image)
                                : std::move(source);
}

}  // namespace telemime
