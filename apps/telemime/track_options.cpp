// SPDX-License-Identifier: Apache-2.0
#include "track_options.h"

#include <charconv>

#include "telemime/core/errors.h"
#include "telemime/likelihood/all.h"
#include "telemime/tracking/heuristics/all.h"

namespace telemime {
namespace {

std::optional<int> whole_number(std::string_view text) {
  int value = 0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  return failure == std::errc() && end == text.data() + text.size() ? std::optional(value) : std::nullopt;
}

void set_size(ImageConfig& image, const std::string& size) {
  const auto cross = size.find('x');
  const auto width = whole_number(std::string_view(size).substr(0, cross));
  const auto height =
      cross == std::string::npos ? std::nullopt : whole_number(std::string_view(size).substr(cross + 1));
  if (!width || !height) {
    throw Error(ErrorKind::usage, "--size " + size + " is not WIDTHxHEIGHT", "For instance --size 320x240.");
  }
  image.width = *width;
  image.height = *height;
}

void set_method(Config& config, const std::string& method) {
  if (method.empty()) {
    return;
  }
  if (method == "heuristics" || method == "condensation") {
    config.tracking.method = method;
    return;
  }
  for (const Method step : {Method::two_step, Method::regions, Method::edges}) {
    if (method == to_string(step)) {
      config.tracking.method = "two-step";
      config.registration.method = step;
      return;
    }
  }
  throw Error(ErrorKind::usage, "unknown method '" + method + "'",
              "Use heuristics, condensation, two-step, regions or edges.");
}

}  // namespace

void add_track_options(CLI::App& command, TrackOptions& o) {
  TrackRequest& r = o.request;
  command
      .add_option("INPUT", r.input, "video file, image folder or pattern, stream URL, camera index or device")
      ->required();
  command.add_option("--background", r.background, "clip of the same scene without the person");
  command.add_option("--camera", r.camera, "OpenCV camera calibration (YAML, XML or JSON)");
  command.add_option("--fov", o.field_of_view,
                     "horizontal field of view in degrees when there is no --camera [60]");
  command.add_option("--height", o.height, "the person's height in metres: sets the absolute scale");
  command.add_option("--size", o.size,
                     "working image, WIDTHxHEIGHT [320x240]; as many pixels in the input's shape");
  command.add_option("--method", o.method,
                     "heuristics, condensation, two-step, regions or edges [heuristics]");
  command.add_option("--particles", o.particles, "evaluations a frame of heuristics and condensation [2000]");
  command.add_option("--heuristics", o.heuristics,
                     "with commas, of " + heuristic_names() + " [" + FilterConfig().heuristics + "]");
  command.add_option("--iterations", o.iterations, "cost evaluations a frame of the other methods [2000]");
  command.add_option(
      "--budget", o.budget_ms,
      "search time a frame in ms, instead of --particles or --iterations (see `telemime-lab tune`)");
  command.add_option("--threads", o.threads, "for the search of heuristics and condensation [all]");
  command.add_option("--limits", o.limits, "joint limits: reference, anatomical or a JSON file [anatomical]");
  command.add_option("--backend", o.backend, "what evaluates poses: " + backend_names() + " [simd]");
  command.add_option("--smoothing", o.smoothing, "none, recursive or one-euro [one-euro]");
  command.add_option("--config", o.config_file, "JSON file of settings (`telemime config` prints one)");
  command.add_option("--seed", o.seed, "of every random draw [1]");
  command.add_option("--frames", r.most_frames, "stop after so many frames");
  command.add_flag("--quiet", o.quiet, "print only errors");
}

TrackRequest make_request(const TrackOptions& o) {
  TrackRequest request = o.request;
  Config& config = request.config;
  if (!o.config_file.empty()) {
    update_from_file(config, o.config_file);
  }
  config.field_of_view = o.field_of_view.value_or(config.field_of_view);
  config.calibration.stature = o.height ? o.height : config.calibration.stature;
  if (!o.size.empty()) {
    set_size(config.image, o.size);
  }
  set_method(config, o.method);
  config.filter.particles = o.particles.value_or(config.filter.particles);
  config.filter.heuristics = o.heuristics.value_or(config.filter.heuristics);
  config.threads = o.threads.value_or(config.threads);
  config.registration.iterations = o.iterations.value_or(config.registration.iterations);
  config.budget_ms = o.budget_ms ? o.budget_ms : config.budget_ms;
  config.limits = o.limits.empty() ? config.limits : o.limits;
  config.backend = o.backend.empty() ? config.backend : o.backend;
  config.seed = o.seed.value_or(config.seed);
  config.smoothing.name = o.smoothing.empty() ? config.smoothing.name : o.smoothing;
  config.look_back = config.look_back || o.offline;
  config.validate();
  return request;
}

}  // namespace telemime
