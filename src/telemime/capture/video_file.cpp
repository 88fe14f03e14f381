// SPDX-License-Identifier: Apache-2.0
#include "telemime/capture/video_file.h"

#include <algorithm>
#include <cstdint>
#include <opencv2/videoio/registry.hpp>
#include <utility>

#include "telemime/capture/picture.h"
#include "telemime/core/time_base.h"

namespace telemime {
namespace {

constexpr int kFirstStamps = 120;  // frames that the rate is measured in

/// Headers of some containers only estimate the number of frames, so a few missing ones mean nothing.
bool ends_early(double read, double promised) {
  return promised - read > std::max(4.0, promised / 20.0);
}

class VideoFile : public Source {
 public:
  VideoFile(const OpenVideo& opened, const InputOptions& options)
      : video_(opened.video), stated_fps_(video_.get(cv::CAP_PROP_FPS)), by_number_(options.rate > 0.0) {
    info_.name = opened.name;
    info_.frames = std::max<std::int64_t>(0, static_cast<std::int64_t>(video_.get(cv::CAP_PROP_FRAME_COUNT)));
    info_.fps = by_number_ ? options.rate : usable_fps(stated_fps_, rate_of(opened.stamps), notes_);
    info_.pixel_aspect = pixel_aspect(video_);
    times_ = TimeBase(info_.fps);
    ahead_ = read();
    if (ahead_.image.empty()) {
      throw cannot_read(opened.name, opened.kind, "it can be opened, but has no frame that can be decoded",
                        "Play it to check that it is complete, or convert it: ffmpeg -i INPUT output.mp4");
    }
    require_usable_size(ahead_.image.size(), opened.name);
    info_.width = ahead_.image.cols;
    info_.height = ahead_.image.rows;
  }

  const SourceInfo& info() const override { return info_; }
  std::string complaint() const override { return notes_.text(); }

  std::optional<Frame> next() override {
    if (ended_) {
      return std::nullopt;
    }
    if (ahead_.image.empty()) {
      finish();
      return std::nullopt;
    }
    const Picture now = std::exchange(ahead_, {});
    ahead_ = read();
    time_ = times_.next(now.stamp, ahead_.stamp);
    return Frame{fit_to(now.image, {info_.width, info_.height}, notes_), index_++, time_};
  }

 private:
  struct Picture {
    cv::Mat image;                ///< empty: the video has ended
    std::optional<double> stamp;  ///< s
  };

  Picture read() {
    cv::Mat image = decode();
    if (image.empty()) {
      return {};
    }
    // The decoder's last frames come without a time stamp (0).
    const double ms = video_.get(cv::CAP_PROP_POS_MSEC);
    const bool has_none = by_number_ || (ms == 0.0 && decoded_ > 0);
    ++decoded_;
    return {image, has_none ? std::nullopt : std::optional(ms / 1000.0)};
  }

  cv::Mat decode() {
    cv::Mat image;  // a new one each time: OpenCV would overwrite a returned frame
    try {
      video_.read(image);
    } catch (const cv::Exception&) {
      notes_.add("frame " + std::to_string(decoded_) + " cannot be decoded; reading ended there");
      return {};
    }
    return with_square_pixels(to_bgr8(image), info_.pixel_aspect);
  }

  void finish() {
    ended_ = true;
    // A number of frames may be the stated length at the stated rate, which a variable rate does not have.
    const auto promised = static_cast<double>(info_.frames);
    const bool short_of_time =
        !(stated_fps_ > 0.0) || by_number_ || ends_early(time_ * stated_fps_ + 1.0, promised);
    if (ends_early(static_cast<double>(index_), promised) && short_of_time) {
      notes_.add("it ended after " + std::to_string(index_) + " frames, but its header states " +
                 std::to_string(info_.frames) + "; the file may be cut off or damaged");
    }
  }

  cv::VideoCapture video_;
  SourceInfo info_;
  Notes notes_;
  Picture ahead_;             // the next frame: its time stamp tells whether that of this one is right
  std::int64_t decoded_ = 0;  // frames
  std::int64_t index_ = 0;
  double stated_fps_;
  bool by_number_;  // of the frame, instead of by time stamps
  TimeBase times_{25.0};
  double time_ = 0.0;  // of the last frame, s
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

std::vector<double> first_stamps(cv::VideoCapture video) {
  std::vector<double> stamps;
  try {
    while (std::ssize(stamps) < kFirstStamps && video.grab()) {
      stamps.push_back(video.get(cv::CAP_PROP_POS_MSEC) / 1000.0);
    }
  } catch (const cv::Exception&) {  // what cannot be decoded is reported when it is read
    return stamps;
  }
  return stamps;
}

double pixel_aspect(const cv::VideoCapture& video) {
  const double aspect = video.get(cv::CAP_PROP_SAR_NUM) / video.get(cv::CAP_PROP_SAR_DEN);
  const auto turn = static_cast<int>(video.get(cv::CAP_PROP_ORIENTATION_META));
  const double shown = turn % 180 == 0 ? aspect : 1.0 / aspect;
  constexpr double kMost = 4.0;
  return shown > 1.0 / kMost && shown < kMost ? shown : 1.0;
}

std::unique_ptr<Source> video_source(const OpenVideo& opened, const InputOptions& options) {
  return std::make_unique<VideoFile>(opened, options);
}

std::unique_ptr<Source> open_video_file(const std::string& path, const InputOptions& options) {
  require_readable_file(path, InputKind::video_file);
  if (looks_like_text(path)) {
    throw cannot_read(path, InputKind::video_file, "it is a text file, not a video",
                      "Give the video itself; a stream is given by its URL.");
  }
  const std::string name = file_backend() == cv::CAP_FFMPEG ? name_for_ffmpeg(path) : path;
  const cv::VideoCapture video(name, file_backend());
  if (!video.isOpened()) {
    throw cannot_read(path, InputKind::video_file,
                      "it is not a video, is cut off, or has an unknown encoding",
                      "Play it to check that it is complete, or convert it: ffmpeg -i INPUT output.mp4");
  }
  return video_source({.video = video,
                       .name = path,
                       .kind = InputKind::video_file,
                       .stamps = first_stamps(cv::VideoCapture(name, file_backend()))},
                      options);
}

}  // namespace telemime
