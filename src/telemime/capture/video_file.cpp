// SPDX-License-Identifier: Apache-2.0
#include "telemime/capture/video_file.h"

#include <algorithm>
#include <cstdint>
#include <opencv2/videoio/registry.hpp>
#include <utility>

#include "telemime/capture/input_kind.h"
#include "telemime/capture/picture.h"

namespace telemime {
namespace {

constexpr double longest_step = 10.0;  // seconds; a larger jump between time stamps is a fault of the file

/// Headers of some containers only estimate the number of frames, so a few missing ones mean nothing.
bool ends_early(std::int64_t read, std::int64_t promised) {
  return promised - read > std::max<std::int64_t>(4, promised / 20);
}

class VideoFile : public Source {
 public:
  VideoFile(const cv::VideoCapture& video, const std::string& name, InputKind kind) : video_(video) {
    info_.name = name;
    info_.frames = std::max<std::int64_t>(0, static_cast<std::int64_t>(video_.get(cv::CAP_PROP_FRAME_COUNT)));
    info_.fps = usable_fps(video_.get(cv::CAP_PROP_FPS), notes_);
    first_ = decode();
    if (first_.empty()) {
      throw cannot_read(name, kind, "it can be opened, but has no frame that can be decoded",
                        "Play it to see that it is whole, or convert it: ffmpeg -i INPUT output.mp4");
    }
    require_usable_size(first_.size(), name);
    info_.width = first_.cols;
    info_.height = first_.rows;
    stamp_ = video_.get(cv::CAP_PROP_POS_MSEC) / 1000.0;
  }

  const SourceInfo& info() const override { return info_; }
  std::string complaint() const override { return notes_.text(); }

  std::optional<Frame> next() override {
    if (ended_) {
      return std::nullopt;
    }
    if (!first_.empty()) {
      return Frame{std::exchange(first_, {}), index_++, 0.0};
    }
    const cv::Mat image = decode();
    if (image.empty()) {
      finish();
      return std::nullopt;
    }
    time_ += step();
    return Frame{fit_to(image, {info_.width, info_.height}, notes_), index_++, time_};
  }

 private:
  cv::Mat decode() {
    cv::Mat image;  // a new one each time: OpenCV would overwrite a returned frame
    try {
      video_.read(image);
    } catch (const cv::Exception&) {
      notes_.add("frame " + std::to_string(index_) + " cannot be decoded; reading ended there");
      return {};
    }
    return to_bgr8(image);
  }

  /// Seconds since the previous frame. The decoder's last frames come without a time stamp (0).
  double step() {
    const double previous = std::exchange(stamp_, video_.get(cv::CAP_PROP_POS_MSEC) / 1000.0);
    const double passed = stamp_ - previous;
    return passed > 0.0 && passed < longest_step ? passed : 1.0 / info_.fps;
  }

  void finish() {
    ended_ = true;
    if (ends_early(index_, info_.frames)) {
      notes_.add("it ended after " + std::to_string(index_) + " frames, but its header states " +
                 std::to_string(info_.frames) + "; the file may be cut off or damaged");
    }
  }

  cv::VideoCapture video_;
  SourceInfo info_;
  Notes notes_;
  cv::Mat first_;
  std::int64_t index_ = 0;
  double stamp_ = 0.0;  // time stamp of the last frame in the file, s
  double time_ = 0.0;   // time of the last returned frame, s
  bool ended_ = false;
};

/// FFmpeg alone where OpenCV has it: other readers take "clip1.mp4" for a numbered image, or print.
int file_backend() {
  for (const cv::VideoCaptureAPIs backend : cv::videoio_registry::getStreamBackends()) {
    if (backend == cv::CAP_FFMPEG) {
      return cv::CAP_FFMPEG;
    }
  }
  return cv::CAP_ANY;
}

}  // namespace

std::unique_ptr<Source> video_source(const cv::VideoCapture& video, const std::string& name, InputKind kind) {
  return std::make_unique<VideoFile>(video, name, kind);
}

std::unique_ptr<Source> open_video_file(const std::string& path) {
  require_readable_file(path, InputKind::video_file);
  if (looks_like_text(path)) {
    throw cannot_read(path, InputKind::video_file, "it is a text file, not a video",
                      "Give the video itself; a stream is given by its URL.");
  }
  const cv::VideoCapture video(path, file_backend());
  if (!video.isOpened()) {
    throw cannot_read(path, InputKind::video_file,
                      "it is not a video, is cut off, or has an unknown encoding",
                      "Play it to see that it is whole, or convert it: ffmpeg -i INPUT output.mp4");
  }
  return video_source(video, path, InputKind::video_file);
}

}  // namespace telemime
