// SPDX-License-Identifier: Apache-2.0
#include "telemime/offline/finished_run.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>

#include "telemime/capture/input_kind.h"

namespace telemime {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

// What has no time of its own (nothing, a stream, a pattern of images, a preset's name) is taken for
// unchanged.
bool is_newer(const std::string& file, fs::file_time_type than) {
  std::error_code unknown;
  const auto time = fs::last_write_time(file, unknown);
  return !unknown && time > than;
}

}  // namespace

Json request_json(const TrackRequest& r) {
  Json settings = to_json(r.config);
  settings.erase("threads");
  return {{"version", r.version},
          {"input", shown_url(r.input)},
          {"rate", r.input_options.rate},
          {"mirrored", r.input_options.mirrored},
          {"background", shown_url(r.background)},
          {"camera", r.camera},
          {"calibration", r.calibration},
          {"formats", r.formats},
          {"bap_profile", r.output_options.bap_profile},
          {"fingers", r.output_options.fingers},
          {"overlay", r.overlay},
          {"frames", r.most_frames},
          {"networks", uses_networks(r.config)},
          {"settings", settings}};
}

bool is_finished(const TrackRequest& request) {
  const fs::path file = request.out / "report.json";
  std::error_code missing;
  const auto written = fs::last_write_time(file, missing);
  if (missing) {
    return false;
  }
  std::ifstream stream(file);
  const Json report = Json::parse(stream, nullptr, false);
  if (!report.is_object() || report.value("interrupted", Json(true)) != Json(false) ||
      report.value("request", Json()) != request_json(request) || !report.value("files", Json()).is_array()) {
    return false;
  }
  const auto is_there = [](const Json& name) {
    std::error_code ignored;
    return name.is_string() && fs::exists(name.get<std::string>(), ignored);
  };
  const auto& files = report.at("files");
  const std::array<std::string, 6> read = {without_file_scheme(request.input),
                                           without_file_scheme(request.background),
                                           request.camera,
                                           request.calibration,
                                           request.config.limits,
                                           request.config.filter.model};
  return std::all_of(files.begin(), files.end(), is_there) &&
         std::none_of(read.begin(), read.end(),
                      [&](const std::string& name) { return is_newer(name, written); });
}

}  // namespace telemime
