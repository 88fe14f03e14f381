// SPDX-License-Identifier: Apache-2.0
#include "telemime/capture/stream.h"

#include <cmath>

#include "telemime/capture/jpeg.h"
#include "telemime/capture/picture.h"
#include "telemime/capture/video_file.h"

namespace telemime {
namespace {

constexpr int kMostDamaged = 25;    // consecutive images: then the sender has probably stopped
constexpr double kSilent = 1.0;     // s; no decoder takes this long to fail
constexpr double kTimedOut = 0.95;  // of the patience

// A container's tag, or the beginning of the codec's name where there is no container, as over HTTP.
bool is_motion_jpeg(const cv::VideoCapture& connection) {
  const auto code = static_cast<int>(connection.get(cv::CAP_PROP_FOURCC));
  return code == cv::VideoWriter::fourcc('M', 'J', 'P', 'G') ||
         code == cv::VideoWriter::fourcc('m', 'j', 'p', 'g') ||
         code == cv::VideoWriter::fourcc('m', 'j', 'p', 'e');
}

}  // namespace

cv::VideoCapture connect_to_stream(const std::string& url, double patience) {
  const int ms = static_cast<int>(std::lround(1000.0 * patience));
  cv::VideoCapture connection;
  connection.open(url, cv::CAP_FFMPEG,
                  {cv::CAP_PROP_OPEN_TIMEOUT_MSEC, ms, cv::CAP_PROP_READ_TIMEOUT_MSEC, ms});
  return connection;
}

bool grab_past_damage(const std::function<bool()>& grab, double patience, const Clock& clock) {
  for (int attempt = 0; attempt < kMostDamaged; ++attempt) {
    const double begun = clock.now();
    const bool grabbed = grab();
    const double passed = clock.now() - begun;
    if (grabbed) {
      return passed < kTimedOut * patience;
    }
    if (passed > kSilent) {
      return false;
    }
  }
  return false;
}

LiveDevice stream_device(const cv::VideoCapture& connection, double patience, const Clock& clock) {
  if (!connection.isOpened()) {
    return {};
  }
  // Copies of a VideoCapture share the same connection.
  const double fps = connection.get(cv::CAP_PROP_FPS);
  cv::VideoCapture video = connection;
  constexpr double kUndecoded = -1.0;
  if (is_motion_jpeg(video) && video.set(cv::CAP_PROP_FORMAT, kUndecoded)) {
    return {[video]() mutable { return video.grab(); },
            [video](cv::Mat& picture) mutable {
              cv::Mat packet;
              if (video.retrieve(packet) && !packet.empty()) {
                picture = decode_jpeg({packet.ptr(), packet.total()});
              }
              return !picture.empty();
            },
            {},
            fps};
  }
  return {[video, patience, clock]() mutable {
            return grab_past_damage([&video] { return video.grab(); }, patience, clock);
          },
          [video, aspect = pixel_aspect(video)](cv::Mat& picture) mutable {
            cv::Mat stored;
            const bool whole = video.retrieve(stored);
            picture = with_square_pixels(stored, aspect);
            return whole;
          },
          {},
          fps};
}

}  // namespace telemime
