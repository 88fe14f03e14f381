// SPDX-License-Identifier: Apache-2.0
#include "telemime/offline/finished_run.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>

#include "telemime/capture/image_sequence.h"
#include "telemime/core/errors.h"
#include "telemime/offline/run_outputs.h"

namespace telemime {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

// A digest of name, size and time of each image; null without images. FNV-1a, as std::hash may differ from
// one build to the next.
Json identity_of_images(const std::string& input, InputKind kind) {
  std::uint64_t digest = 14695981039346656037U;
  std::size_t count = 0;
  try {
    for (const fs::path& image : image_files(input, kind)) {
      std::error_code unknown;
      const std::uintmax_t size = fs::file_size(image, unknown);
      const auto time = fs::last_write_time(image, unknown).time_since_epoch().count();
      for (const char c : image.string() + " " + std::to_string(size) + " " + std::to_string(time) + "\n") {
        digest = (digest ^ static_cast<unsigned char>(c)) * 1099511628211U;
      }
      ++count;
    }
  } catch (const Error&) {
    return nullptr;
  }
  return {{"images", count}, {"digest", digest}};
}

// Size and time of a file, which distinguish it from another of the same name; of a folder or a pattern,
// name, size and time of each image. Null for what has none (nothing, a stream, a preset's name).
Json identity_of(const std::string& name) {
  const std::string file = without_file_scheme(name);
  const InputKind kind = input_kind(name);
  if (kind == InputKind::folder || kind == InputKind::pattern) {
    return identity_of_images(file, kind);
  }
  std::error_code unknown;
  const auto time = fs::last_write_time(file, unknown);
  if (unknown) {
    return nullptr;
  }
  const std::uintmax_t size = fs::is_regular_file(file, unknown) ? fs::file_size(file, unknown) : 0;
  return {{"size", size}, {"time", time.time_since_epoch().count()}};
}

// As it is after it was written and read: names that are not UTF-8 change.
Json as_read(const Json& json) {
  return Json::parse(json.dump(-1, ' ', false, Json::error_handler_t::replace));
}

}  // namespace

Json request_json(const TrackRequest& r) {
  Json settings = to_json(r.config);
  settings.erase("threads");
  Json identities = Json::array();
  for (const std::string& name : names_read(r)) {
    identities.push_back(identity_of(name));
  }
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
          {"read", identities},
          {"settings", settings}};
}

FinishedRun finished_run(const TrackRequest& request) {
  // Nothing tells whether a stream, or a clip on a server, is still the same.
  if (input_kind(request.input) == InputKind::stream) {
    return FinishedRun::none;
  }
  std::ifstream stream(request.out / "report.json");
  const Json report = Json::parse(stream, nullptr, false);
  if (!report.is_object() || report.value("interrupted", Json(true)) != Json(false) ||
      report.value("request", Json()) != as_read(request_json(request)) ||
      !report.value("files", Json()).is_array()) {
    return FinishedRun::none;
  }
  const auto is_there = [](const Json& name) {
    std::error_code ignored;
    return name.is_string() && fs::exists(name.get<std::string>(), ignored);
  };
  const auto& files = report.at("files");
  if (!std::all_of(files.begin(), files.end(), is_there)) {
    return FinishedRun::none;
  }
  return report.value("tracked", Json()) == Json(0) ? FinishedRun::nobody_tracked : FinishedRun::complete;
}

}  // namespace telemime
