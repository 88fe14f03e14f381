// SPDX-License-Identifier: Apache-2.0
#include "telemime/offline/run_outputs.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

#include "telemime/capture/image_sequence.h"
#include "telemime/capture/input_kind.h"
#include "telemime/core/errors.h"
#include "telemime/core/files.h"

namespace telemime {
namespace {

bool is_asked_for(const std::vector<std::string>& formats, const OutputFormat& format) {
  return formats.empty() || std::find(formats.begin(), formats.end(), format.name) != formats.end();
}

// Whether the result lies in this folder.
bool lies_in(const std::filesystem::path& result, const std::filesystem::path& folder) {
  std::error_code apart;
  return std::filesystem::equivalent(result.parent_path(), folder, apart);
}

// A result in the place of a file that is being read would destroy it.
void keep_inputs(const TrackRequest& request, const std::filesystem::path& result) {
  const auto is_result = [&result](const std::filesystem::path& name) {
    std::error_code apart;
    return std::filesystem::equivalent(name, result, apart);
  };
  for (const std::string& name : names_read(request)) {
    const InputKind kind = input_kind(name);
    bool replaced = is_result(without_file_scheme(name));
    if (kind == InputKind::folder || kind == InputKind::pattern) {
      try {
        const auto images = image_files(without_file_scheme(name), kind);
        // A picture among them would be one of them from the next run on.
        replaced = std::any_of(images.begin(), images.end(), is_result) ||
                   (kind == InputKind::folder && has_image_extension(result.string()) &&
                    lies_in(result, without_file_scheme(name)));
      } catch (const Error&) {
        replaced = false;  // whoever reads them says so
      }
    }
    if (!name.empty() && replaced) {
      throw Error(ErrorKind::usage, result.string() + " is read by this run and would be replaced",
                  "Choose another place for the results with --out.");
    }
  }
}

}  // namespace

std::array<std::string, 6> names_read(const TrackRequest& r) {
  return {r.input, r.background, r.camera, r.calibration, r.config.limits, r.config.filter.model};
}

void prepare_outputs(const TrackRequest& request) {
  for (const std::string& name : request.formats) {
    output_format(name);  // throws for one that there is not
  }
  for (const OutputFormat& format : kOutputFormats) {
    format.make(request.output_options);  // and for options that it cannot use
  }
  if (request.out.empty()) {
    return;
  }
  std::error_code failure;
  std::filesystem::create_directories(request.out, failure);
  if (failure) {
    throw cannot_write(request.out, failure.value());
  }
  if (access(request.out.c_str(), W_OK) != 0) {
    throw cannot_write(request.out, errno);
  }
  for (const OutputFormat& format : kOutputFormats) {
    if (is_asked_for(request.formats, format)) {
      keep_inputs(request, request.out / format.file_name);
    }
  }
  keep_inputs(request, request.out / "report.json");
  if (request.overlay) {
    keep_inputs(request, request.out / OverlayVideo::kFileName);
    keep_inputs(request, request.out / OverlayVideo::kPictureName);
  }
}

void prepare_file(const std::filesystem::path& file, const TrackRequest& request) {
  keep_inputs(request, file);
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  if (access(folder.c_str(), W_OK) != 0) {
    throw cannot_write(file, errno);
  }
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) {
    throw cannot_write(file, EISDIR);
  }
}

void RunOutputs::set_body(const Body& body) {
  if (resampler_) {
    resampler_->set_body(body);
  }
}

RunOutputs::RunOutputs(const TrackRequest& request, double fps, OverlayVideo::Note note)
    : folder_(request.out), formats_(request.formats), options_(request.output_options) {
  prepare_outputs(request);
  // The files of an earlier run are about to be replaced; its report would make a run that is cut off pass
  // for finished (finished_run.h).
  if (!folder_.empty()) {
    std::error_code failure;
    std::filesystem::remove(folder_ / "report.json", failure);
    if (failure) {
      throw cannot_write(folder_ / "report.json", failure.value());
    }
  }
  if (request.overlay && !folder_.empty()) {
    video_.emplace(folder_, fps, std::move(note));
  }
}

void RunOutputs::begin(const StreamHeader& known) {
  if (folder_.empty()) {
    return;
  }
  StreamHeader header = known;
  header.fingers = known.fingers && options_.fingers;
  resampler_.emplace(header.body, header.camera, header.fps);
  for (const OutputFormat& format : kOutputFormats) {
    if (is_asked_for(formats_, format)) {
      outputs_.open(folder_, format, options_, header);
    }
  }
}

void RunOutputs::write(const MotionFrame& frame) {
  if (!resampler_) {
    return;
  }
  outputs_.write(frame, true);
  resampler_->push(frame, [this](const MotionFrame& made) { outputs_.write(made, false); });
}

void RunOutputs::write_overlay(const cv::Mat& picture, double time) {
  if (video_) {
    video_->write(picture, time);
  }
}

void RunOutputs::close_overlay() {
  if (video_) {
    video_->close();
  }
}

void RunOutputs::close(const nlohmann::json& report) {
  for (const MotionFiles::File& file : outputs_.all) {
    file.output->close();
  }
  if (folder_.empty()) {
    return;
  }
  write_whole_file(folder_ / "report.json",
                   report.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

std::vector<std::string> RunOutputs::files() const {
  std::vector<std::string> names;
  for (const MotionFiles::File& file : outputs_.all) {
    names.push_back(file.output->path().string());
  }
  if (video_ && !video_->file().empty()) {
    names.push_back(video_->file());
  }
  return names;
}

}  // namespace telemime
