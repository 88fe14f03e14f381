// SPDX-License-Identifier: Apache-2.0
#include "telemime/offline/overlay_video.h"

#include <cmath>
#include <exception>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <system_error>
#include <utility>
#include <vector>

#include "telemime/capture/input_kind.h"
#include "telemime/core/files.h"
#include "telemime/offline/resampler.h"

namespace telemime {

double overlay_rate(double fps) {
  constexpr double kMost = 60.0;  // MPEG-4 has 16 bits for a thousand times the rate
  return fps / std::max(1.0, std::ceil(fps / kMost - 1e-3));
}

OverlayVideo::OverlayVideo(const std::filesystem::path& folder, double fps, Note note)
    : file_(folder / kFileName),
      rate_(overlay_rate(fps)),
      longest_gap_(longest_gap(fps)),
      note_(std::move(note)) {
  // A small video in its place.
  const cv::Mat black = cv::Mat::zeros(48, 64, CV_8UC3);
  if (open(black.size())) {
    video_.write(black);
    video_.release();
    std::error_code unreadable;
    if (const auto bytes = std::filesystem::file_size(file_, unreadable); unreadable || bytes == 0) {
      fail("nothing is written; is the disk full?");
    }
    std::filesystem::remove(file_, unreadable);
  }
}

bool OverlayVideo::open(cv::Size size) {
  try {
    video_.open(name_for_ffmpeg(file_.string()), cv::CAP_FFMPEG, cv::VideoWriter::fourcc('m', 'p', '4', 'v'),
                rate_, size);
  } catch (const cv::Exception&) {
    video_.release();
  }
  if (!video_.isOpened()) {
    fail("OpenCV cannot start an MPEG-4 video there");
  }
  return usable_;
}

void OverlayVideo::fail(const std::string& why) {
  usable_ = false;
  video_.release();
  if (note_) {
    note_("the overlay video " + file_.string() + " is not written: " + why);
  }
}

void OverlayVideo::write(const cv::Mat& picture, double time) {
  if (!usable_ || (pictures_ == 0 && !open(picture.size()))) {
    return;
  }
  if (pictures_ == 0) {
    start_ = time;
  }
  constexpr double kSlack = 1e-3;  // s, for time stamps in ms
  const auto due = [&] { return start_ + static_cast<double>(written_) / rate_; };
  try {
    // The last picture until now.
    if (pictures_ > 0 && time - last_time_ > longest_gap_) {
      cv::putText(last_, "no frame", {8, 24}, cv::FONT_HERSHEY_SIMPLEX, 0.7, cv::Scalar(80, 80, 255), 2,
                  cv::LINE_AA);
    }
    for (; due() < time - kSlack; ++written_) {
      video_.write(last_);
    }
    if (due() <= time + kSlack) {
      video_.write(picture);
      ++written_;
    }
    // A picture from the middle of what was tracked so far: the later ones replace it less and less often.
    ++pictures_;
    if ((pictures_ & (pictures_ - 1)) == 0) {
      best_ = picture.clone();
    }
    last_ = picture.clone();
    last_time_ = time;
  } catch (const std::exception& e) {
    fail(e.what());
  }
}

void OverlayVideo::close() {
  video_.release();
  if (best_.empty()) {
    return;
  }
  try {
    std::vector<unsigned char> png;
    cv::imencode(".png", best_, png);
    write_whole_file(file_.parent_path() / kPictureName, std::string(png.begin(), png.end()));
  } catch (const std::exception& e) {
    if (note_) {
      note_(std::string("the overlay picture is not written: ") + e.what());
    }
  }
}

}  // namespace telemime
