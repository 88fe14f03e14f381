// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracker/set_up.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "telemime/capture/undistorted_source.h"
#include "telemime/core/errors.h"
#include "telemime/core/files.h"
#include "telemime/core/in_parallel.h"
#include "telemime/likelihood/all.h"
#include "telemime/search/budget.h"
#include "telemime/tracker/person_file.h"

namespace telemime {
namespace {

// The camera scaled to the input's size; another aspect ratio cannot be the same camera's. It may be that of
// the pixels as they are stored.
Camera fitting(const Camera& camera, const SourceInfo& info) {
  const double aspect =
      static_cast<double>(camera.width) * info.height / (static_cast<double>(camera.height) * info.width);
  if (std::abs(aspect - 1.0) > 0.02 && std::abs(aspect * info.pixel_aspect - 1.0) > 0.02) {
    throw Error(ErrorKind::config,
                "the camera is for " + std::to_string(camera.width) + "x" + std::to_string(camera.height) +
                    " and the input has " + std::to_string(info.width) + "x" + std::to_string(info.height) +
                    " pixels",
                "Calibrate at the input's aspect ratio, or use --fov.");
  }
  return camera.scaled_to(info.width, info.height);
}

}  // namespace

Camera camera_for(const SourceInfo& info, const std::string& file, double field_of_view) {
  return file.empty() ? camera_from_field_of_view(info.width, info.height, field_of_view)
                      : fitting(load_camera(file), info);
}

Lens lens_for(const SourceInfo& info, const TrackRequest& request) {
  Lens lens;
  if (!request.calibration.empty()) {
    // The person and the background were measured with this camera, whatever --camera says.
    lens = parse_person(read_text_file(request.calibration, ErrorKind::config), request.calibration).lens;
  } else if (!request.camera.empty()) {
    lens = load_lens(request.camera);
    lens = request.input_options.mirrored ? lens.mirrored() : lens;
  } else {
    lens.camera = camera_for(info, "", request.config.field_of_view);
  }
  lens.camera = fitting(lens.camera, info);
  return lens;
}

std::unique_ptr<Source> without_distortion(std::unique_ptr<Source> source, const TrackRequest& request) {
  const Lens lens = lens_for(source->info(), request);
  return undistorted(std::move(source), lens);
}

StreamHeader header_of(const SourceInfo& info, const TrackingRun& run) {
  StreamHeader header;
  header.body = run.state.model.body;
  header.camera = run.tracker.camera;
  header.fps = info.fps;
  header.limits = run.tracker.limits;
  header.fingers = run.scene.hands.has_networks();
  header.config = to_json(run.tracker.config);
  header.extra = {{"input", info.name}};
  if (run.state.person) {
    header.extra["scale_from"] = run.state.person->scale_from;
    header.extra["calibration_refusal"] = run.state.person->refusal;
  }
  return header;
}

Config with_budget(const Config& config, const Camera& camera) {
  if (!config.budget_ms) {
    return config;
  }
  const auto backend = make_backend(config.backend);
  Random random(config.seed);
  const auto seconds = [] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
  };
  constexpr int kRepeats = 5;
  const ImageConfig image = fitted_to(config.image, camera);
  const EvaluationCost cost = measure_cost(
      *backend, make_model(Shape{}), camera.scaled_to(image.width, image.height), kRepeats, random, seconds);
  const Split split = split_for_budget(*config.budget_ms, cost.region_ms, cost.edge_ms, default_fit());
  Config fixed = config;
  constexpr std::int64_t kMost = 1000000;  // that a configuration may ask for
  const std::int64_t total = std::clamp<std::int64_t>(split.total(), 1, kMost - 1);
  fixed.registration.iterations = static_cast<int>(total + 1);  // the last evaluation scores the pose
  // The best mode has at most two searches in full, side by side where there are two threads, and up to three
  // trunks are turned, two of them with a long search. With landmarks the second is brief, and two of their
  // proposals are searched. Together no more than the total on each thread.
  const std::int64_t threads = usable_threads(config.threads);
  const auto at_most = [](int number, std::int64_t most) {
    return static_cast<int>(std::clamp<std::int64_t>(number, 1, std::max<std::int64_t>(1, most)));
  };
  FilterConfig& filter = fixed.filter;
  constexpr std::int64_t kLeast = 10;  // that a configuration may ask for, of a search
  filter.mode_most = at_most(filter.mode_most, std::max(kLeast, threads > 1 ? 2 * total / 3 : total / 3));
  filter.mode_least =
      at_most(filter.mode_least, std::clamp<std::int64_t>(total / 10, kLeast, filter.mode_most));
  filter.turn_evaluations = at_most(filter.turn_evaluations, std::max(kLeast, total / 10));
  filter.walk_evaluations =
      at_most(filter.walk_evaluations, std::max(kLeast, threads > 1 ? total / 5 : total / 10));
  filter.second_evaluations = at_most(filter.second_evaluations, std::max(kLeast, total / 4));
  filter.landmark_evaluations =
      at_most(filter.landmark_evaluations, std::max(kLeast, threads > 1 ? total / 4 : total / 8));
  filter.particles = static_cast<int>(std::clamp<std::int64_t>(total * threads / 2, 1, kMost));
  if (!config.registration.blocks) {
    fixed.registration.region_share = split.region_share();
  }
  return fixed;
}

TrackingRun open_run(const TrackRequest& request, const SourceInfo& info,
                     std::vector<std::string>& messages) {
  if (resolved(request.config).image.landmarks && !uses_networks(request.config)) {
    messages.emplace_back(
        "the networks that find the person are not installed: tracking by regions and contours alone, which "
        "needs "
        "a still background and clothes of another colour than skin (docs/networks.md says how to install "
        "them)");
  }
  if (request.calibration.empty()) {
    const Camera camera = lens_for(info, request).camera;
    return make_tracking_run(with_budget(request.config, camera), camera);
  }
  const PersonFile person = load_person(request.calibration);
  const Camera camera = fitting(person.camera, info);
  TrackingRun run = make_tracking_run(with_budget(request.config, camera), camera);
  use_calibration(person.person, person.image, run);
  messages.push_back("person and background: " + request.calibration);
  if (request.config.calibration.stature) {
    messages.push_back("the height is not used: the person's size is that of " + request.calibration);
  }
  return run;
}

}  // namespace telemime
