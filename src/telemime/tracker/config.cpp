// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracker/config.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <limits>
#include <sstream>
#include <utility>

#include "telemime/core/errors.h"
#include "telemime/core/text.h"
#include "telemime/likelihood/all.h"
#include "telemime/nets/models/table.h"

namespace telemime {
namespace {

using Json = nlohmann::json;

constexpr std::array<const char*, 3> kQualities = {"fast", "balanced", "best"};

// The settings that `quality` presets, with a value for each quality. `balanced` has the defaults.
struct Preset {
  const char* setting;
  std::array<double, 3> values;
};
constexpr std::array<Preset, 5> kPresets = {{
    {"offline", {0, 1, 1}},
    {"image.width", {240, 320, 320}},
    {"image.height", {180, 240, 240}},
    {"particles", {800, 2000, 4000}},
    {"registration.iterations", {800, 2000, 4000}},
}};

Json preset_value(const Preset& preset, std::size_t quality) {
  const double value = preset.values.at(quality);
  return preset.setting == std::string_view("offline") ? Json(value > 0.0) : Json(static_cast<int>(value));
}

std::vector<std::string> back_end_choices() {
  std::vector<std::string> names;
  for (const BackendKind& kind : kBackends) {
    names.emplace_back(kind.name);
  }
  return names;
}

// Which of the built-in cues a list names. Throws Error(usage) for an unknown name or an empty list.
std::array<bool, kCues.size()> named_cues(const std::string& names) {
  std::array<bool, kCues.size()> named{};
  std::istringstream list(names);
  for (std::string name; std::getline(list, name, ',');) {
    const auto found =
        std::find_if(kCues.begin(), kCues.end(), [&](const Cue& cue) { return cue.name == name; });
    if (found == kCues.end()) {
      throw Error(ErrorKind::usage, "unknown cue '" + name + "'",
                  "Choose from " + joined(kCues, &Cue::name) + ", separated by commas.");
    }
    named[static_cast<std::size_t>(found - kCues.begin())] = true;
  }
  if (std::none_of(named.begin(), named.end(), [](bool n) { return n; })) {
    throw Error(ErrorKind::usage, "no cue is named",
                "Choose from " + joined(kCues, &Cue::name) + ", separated by commas.");
  }
  return named;
}

SettingRule known_cues(const std::string& names) {
  try {
    named_cues(names);
    return {};
  } catch (const Error& error) {
    return {false, std::string("cues: ") + error.what()};
  }
}

SettingTable settings_of(TrackingConfig& c) {
  return {
      {text("method", c.method, {"heuristics", "condensation", "two-step", "regions", "edges"},
            "Particle filter with heuristics or without (condensation), or one pose and a local search over "
            "regions and edges."),
       number("tracking.lost_region", &c.lost_region, {1e-9, 1}, "F",
              "F above which a frame counts as lost."),
       number("tracking.found_region", &c.found_region, {1e-9, 1}, "F",
              "Largest F at which a search has found the person."),
       number("tracking.patience", &c.patience, {1, 1000000}, "1/25 s",
              "Time of bad frames after which the person is lost."),
       number("tracking.retry_every", &c.retry_every, {1, 1000000}, "1/25 s",
              "Interval of the searches while the person is lost."),
       number(
           "tracking.calibration_patience", &c.calibration_patience, {0, 1000000}, "1/25 s",
           "Time to wait for a frame from which the arms can be measured, before an average body is used."),
       number("tracking.fill_back", &c.fill_back, {0, 1000}, "1/25 s",
              "Time while lost in a file that is tracked backward once the person is found."),
       number("tracking.velocity", &c.velocity, {0, 1}, "",
              "Share of the last motion of the arms that is predicted for the next frame.")},
      {}};
}

}  // namespace

Config::Config() {
  image.width = 320;
  image.height = 240;
}

SettingTable settings_of(Config& c) {
  SettingTable table;
  table.rows = {
      text("quality", c.quality, {kQualities.begin(), kQualities.end()},
           "Preset for the settings of speed and accuracy; those that are given override it."),
      number("seed", &c.seed, {0, std::numeric_limits<double>::infinity()}, "",
             "Seed of all random numbers."),
      number("fov", &c.field_of_view, {1, 179}, "degrees",
             "Field of view of the camera along the longer side of the image, when there is no camera file."),
      number("budget", &c.budget_ms, {1e-6, 1e5}, "ms",
             "Time for the search of a frame, in place of particles or iterations; null: no limit."),
      flag("offline", c.look_back,
           "Track a file backward, too, and decide about its frames together: steadier and more accurate. "
           "Only "
           "with the methods heuristics and condensation."),
      flag("face", c.face, "Track head, eyes and expression, where networks find the person."),
      number("threads", &c.threads, {0, 1024}, "",
             "Threads of the search and of the image side; 0: one for each processor."),
      text("cues", c.cue_names, {},
           "Cues that the image is compared by, separated by commas: " + joined(kCues, &Cue::name) + "."),
      flag("hands", c.hands, "Track the fingers, where networks find the person."),
      text("backend", c.backend, back_end_choices(), "Implementation that evaluates poses."),
      text("limits", c.limits, {}, "Joint limits: anatomical, reference (of the thesis) or a JSON file."),
  };
  table.append(settings_of(c.tracking));
  table.append(settings_of(c.image));
  table.append(settings_of(c.calibration));
  table.append(settings_of(c.registration));
  table.append(settings_of(c.filter));
  table.append(settings_of(c.offline));
  table.append(settings_of(c.smoothing));
  std::stable_partition(table.rows.begin(), table.rows.end(),
                        [](const Setting& s) { return s.name.find('.') == std::string::npos; });
  table.rules.push_back(known_cues(c.cue_names));
  return table;
}

void add_cue(Config& config, const Cue& cue) {
  config.cues.add(cue);
  config.registration = with_cues(config.registration, config.cues);
}

bool uses_networks(const Config& config) {
  return resolved(config).image.landmarks && !find_models(config.image.models).empty();
}

bool uses_face(const Config& config) {
  const std::vector<std::string> names = {"face_detection_short_range", "face_landmark_with_attention"};
  return config.face && uses_networks(config) &&
         missing_models(find_models(config.image.models), names).empty();
}

bool uses_hands(const Config& config) {
  const std::vector<std::string> names = {"hand_recrop", "hand_landmark_full"};
  return config.hands && uses_networks(config) &&
         missing_models(find_models(config.image.models), names).empty();
}

bool uses_filter(const Config& config) {
  return config.tracking.method == "heuristics" || config.tracking.method == "condensation";
}

Config resolved(Config config) {
  if (config.tracking.method == "condensation") {
    const FilterConfig given = std::exchange(config.filter, reference_filter(""));
    config.filter.particles = given.particles;
    config.filter.model = given.model;
    config.filter.diffusion = given.diffusion;
    config.filter.estimate = given.estimate;
  } else if (!uses_filter(config)) {
    config.registration.method = parse_method(config.tracking.method);
  }
  config.look_back = config.look_back && uses_filter(config);
  const auto named = named_cues(config.cue_names);
  for (std::size_t i = 0; i < kCues.size(); ++i) {
    config.cues.enable(i, named[i] && config.cues[i].enabled);
  }
  config.image.landmarks = config.image.landmarks && (named[cue::kLandmarks] || named[cue::kBones]);
  return config;
}

Json to_json(Config config) {
  return to_json(settings_of(config));
}

void update(Config& config, const SettingValues& values) {
  Config updated = config;
  const SettingTable table = settings_of(updated);
  if (const auto quality = values.find("quality"); quality != values.end()) {
    const auto known = std::find(kQualities.begin(), kQualities.end(), quality->second);
    for (const Preset& preset : kPresets) {
      if (known != kQualities.end()) {
        assign(table, {{preset.setting,
                        preset_value(preset, static_cast<std::size_t>(known - kQualities.begin()))}});
      }
    }
  }
  assign(table, values);
  updated.validate();
  config = updated;
}

SettingValues parse_settings(std::string_view text, const std::filesystem::path& name) {
  const Json json = Json::parse(text, nullptr, false, true);
  if (json.is_discarded()) {
    throw Error(ErrorKind::config, "configuration file " + name.string() + " is not valid JSON",
                "JSON has no NaN or Infinity; `telemime config` prints a file to start from.");
  }
  return flatten(json);
}

SettingValues read_settings(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in || std::filesystem::is_directory(file)) {
    throw Error(ErrorKind::config, "configuration file " + file.string() + " cannot be opened",
                "Check the path and its permissions.");
  }
  return parse_settings(std::string(std::istreambuf_iterator<char>(in), {}), file);
}

}  // namespace telemime
