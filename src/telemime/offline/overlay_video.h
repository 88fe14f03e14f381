// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <opencv2/core/mat.hpp>
#include <opencv2/videoio.hpp>
#include <string>

namespace telemime {

/// A rate at which MPEG-4 can hold a video of `fps`: itself, or the nearest fraction of it up to 60.
double overlay_rate(double fps);

/// overlay.mp4 and overlay.png of a run. They are side results: what fails becomes a note and ends them,
/// never the run. A picture is shown until the time of the next one; across a longer gap it is marked.
class OverlayVideo {
 public:
  using Note = std::function<void(const std::string&)>;
  static constexpr const char* kFileName = "overlay.mp4";
  static constexpr const char* kPictureName = "overlay.png";

  /// Tries whether a video can be written in the folder. `fps`: of the input. `note` may be empty.
  OverlayVideo(const std::filesystem::path& folder, double fps, Note note);
  bool usable() const { return usable_; }
  /// `time`: of the frame, s; it must increase. The first picture sets the size.
  void write(const cv::Mat& picture, double time);
  /// Ends the video and writes the picture.
  void close();
  /// The video's file; empty if there is none.
  std::string file() const { return pictures_ > 0 ? file_.string() : std::string(); }

 private:
  bool open(cv::Size size);
  void fail(const std::string& why);

  std::filesystem::path file_;
  double rate_;
  double longest_gap_;
  Note note_;
  bool usable_ = true;
  cv::VideoWriter video_;
  cv::Mat last_, best_;
  double start_ = 0.0, last_time_ = 0.0;
  std::int64_t pictures_ = 0;  ///< taken up
  std::int64_t written_ = 0;
};

}  // namespace telemime
