// SPDX-License-Identifier: Apache-2.0
#include "telemime/offline/run_outputs.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <system_error>

#include "telemime/core/files.h"

namespace telemime {

void prepare_outputs(const TrackRequest& request) {
  for (const std::string& name : request.formats) {
    output_format(name);  // throws for one that there is not
  }
  for (const OutputFormat& format : kOutputFormats) {
    format.make(request.output_options);  // and for options that it cannot use
  }
  std::error_code failure;
  std::filesystem::create_directories(request.out, failure);
  if (failure) {
    throw cannot_write(request.out, failure.value());
  }
  if (access(request.out.c_str(), W_OK) != 0) {
    throw cannot_write(request.out, errno);
  }
}

void prepare_file(const std::filesystem::path& file) {
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  if (access(folder.c_str(), W_OK) != 0) {
    throw cannot_write(file, errno);
  }
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) {
    throw cannot_write(file, EISDIR);
  }
}

RunOutputs::RunOutputs(const TrackRequest& request, double fps)
    : folder_(request.out), formats_(request.formats), options_(request.output_options), fps_(fps) {
  prepare_outputs(request);
}

void RunOutputs::begin(const StreamHeader& header) {
  for (const OutputFormat& format : kOutputFormats) {
    if (formats_.empty() || std::find(formats_.begin(), formats_.end(), format.name) != formats_.end()) {
      outputs_.push_back(std::make_unique<FileOutput>(folder_ / std::string(format.file_name),
                                                      format.make(options_), header));
    }
  }
}

void RunOutputs::write(const MotionFrame& frame) {
  for (const auto& output : outputs_) {
    output->write(frame);
  }
}

void RunOutputs::write_overlay(const cv::Mat& picture) {
  if (!video_.isOpened()) {
    const auto file = folder_ / "overlay.mp4";
    video_.open(file.string(), cv::VideoWriter::fourcc('m', 'p', '4', 'v'), fps_, picture.size());
    if (!video_.isOpened()) {
      throw Error(ErrorKind::output,
                  "cannot write " + file.string() + ": OpenCV could not start an MPEG-4 video",
                  "Give --out a folder that you may write, or leave the video out with --no-overlay.");
    }
  }
  video_.write(picture);
  // A picture from the middle of what was tracked so far: the later ones replace it less and less often.
  ++overlays_;
  if ((overlays_ & (overlays_ - 1)) == 0) {
    best_overlay_ = picture.clone();
  }
}

void RunOutputs::close(const nlohmann::json& report) {
  for (const auto& output : outputs_) {
    output->close();
  }
  video_.release();
  if (!best_overlay_.empty()) {
    std::vector<unsigned char> png;
    cv::imencode(".png", best_overlay_, png);
    write_whole_file(folder_ / "overlay.png", std::string(png.begin(), png.end()));
  }
  write_whole_file(folder_ / "report.json", report.dump(2) + "\n");
}

std::vector<std::string> RunOutputs::files() const {
  std::vector<std::string> names;
  for (const auto& output : outputs_) {
    names.push_back(output->path().string());
  }
  if (overlays_ > 0) {
    names.push_back((folder_ / "overlay.mp4").string());
  }
  return names;
}

}  // namespace telemime
