// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace telemime {

/// What a video output asks of the system. Tests give other answers.
struct VideoCalls {
  std::function<int(const char* path)> open;  ///< to read and write, without blocking
  std::function<bool(int file)> is_device;
  std::function<int(int file, unsigned long request, void* argument)> ioctl;
  std::function<ssize_t(int file, const void* bytes, std::size_t size)> write;
};
VideoCalls system_video_calls();

/// A picture (h x w, CV_8UC3, BGR; w even) as YUYV: two pixels in the four bytes Y U Y V, by BT.601 with
/// Y from 16 to 235.
std::vector<std::uint8_t> yuyv_of(const cv::Mat& picture);

/// Writes pictures to a V4L2 output device, such as those of v4l2loopback, or as raw YUYV to an existing FIFO
/// or file. Not thread-safe.
class VideoOutput {
 public:
  explicit VideoOutput(std::filesystem::path path, VideoCalls calls = system_video_calls());
  VideoOutput(const VideoOutput&) = delete;
  VideoOutput& operator=(const VideoOutput&) = delete;
  ~VideoOutput();  ///< close()

  /// Throws Error(output), with the reason and a remedy, unless the path is a device that takes pictures, a
  /// FIFO or a file that this user may write. Empties a file.
  void check();
  /// Opens it on the first call and writes the picture (CV_8UC3, BGR), with black bars if the device has
  /// another size, and without a last odd row or column. Throws Error(output) if it fails; the next call
  /// opens it again. Returns early when `stop` is set: nobody may read a FIFO.
  void write(const cv::Mat& picture, const std::atomic<bool>& stop);
  void close() noexcept;
  const std::filesystem::path& path() const { return path_; }

 private:
  void open();
  cv::Size set_format(cv::Size size);

  std::filesystem::path path_;
  VideoCalls calls_;
  int file_ = -1;
  bool device_ = false;
  cv::Size asked_, size_;  ///< of the pictures, and of the device
};

}  // namespace telemime
