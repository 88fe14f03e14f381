// SPDX-License-Identifier: Apache-2.0
#include "track_options.h"

#include <CLI/Validators.hpp>

#include "telemime/core/errors.h"

namespace telemime {
namespace {

using Json = nlohmann::json;

// A number, true, false or null; anything else is a string.
Json value_from(const std::string& text) {
  Json value = Json::parse(text, nullptr, false);
  return value.is_discarded() || value.is_structured() ? Json(text) : value;
}

}  // namespace

void add_setting_options(CLI::App& command, TrackOptions& o) {
  Config defaults;
  for (const Setting& s : settings_of(defaults).rows) {
    if (s.name.find('.') != std::string::npos) {
      continue;
    }
    const std::string option = "--" + s.name;
    if (std::holds_alternative<bool*>(s.variable)) {
      command.add_flag_function(
          option + ",!--no-" + s.name,
          [&o, name = s.name](std::int64_t count) { o.settings[name] = count > 0; }, s.meaning);
      continue;
    }
    const Json value = value_of(s);
    const std::string text = value.is_string() ? value.get<std::string>()
                             : value.is_null() ? ""
                                               : value.dump();
    const auto store = [&o, name = s.name](const std::string& given) {
      o.settings[name] = value_from(given);
    };
    command
        .add_option_function<std::string>(
            option, store, s.meaning + (s.choices.empty() ? "" : " One of " + range_of(s) + "."))
        ->type_name(s.choices.empty() ? s.unit.empty() ? "VALUE" : "(" + s.unit + ")" : "NAME")
        ->default_str(text);
  }
  command.add_option("--config", o.config_file, "JSON file of settings; `telemime config` prints one.");
  command
      .add_option("--set", o.assignments,
                  "Any setting that `telemime config --explain` lists, as NAME=VALUE; may be repeated.")
      ->allow_extra_args(false);
}

void add_track_options(CLI::App& command, TrackOptions& o) {
  TrackRequest& r = o.request;
  command.add_option("INPUT", r.input, "Video file, folder or pattern of images, or URL of a clip.")
      ->required();
  command.add_option("--background", r.background, "Clip of the same scene without the person.");
  command.add_option("--camera", r.camera, "OpenCV camera calibration (YAML, XML or JSON).");
  command
      .add_option(
          "--rate", r.input_options.rate,
          "Images per second of a sequence [25], or frames per second of a video with wrong time stamps.")
      ->check(CLI::Range(0.001, 1000.0));
  command.add_flag("--mirrored", r.input_options.mirrored, "The input shows a mirror image.");
  add_setting_options(command, o);
  command.add_option("--frames", r.most_frames, "Stop after this number of frames; 0: never.")
      ->check(CLI::NonNegativeNumber);
  command.add_flag("--quiet", o.quiet, "Print errors only.");
}

namespace {

// The values of the public options and of --set.
SettingValues given_settings(const TrackOptions& o) {
  SettingValues values = o.settings;
  for (const std::string& assignment : o.assignments) {
    const std::size_t equals = assignment.find('=');
    if (equals == std::string::npos) {
      throw Error(ErrorKind::usage, "--set " + assignment + " is not NAME=VALUE",
                  "For instance --set image.width=160.");
    }
    values[assignment.substr(0, equals)] = value_from(assignment.substr(equals + 1));
  }
  return values;
}

}  // namespace

SettingValues all_settings(const TrackOptions& o) {
  SettingValues values = o.config_file.empty() ? SettingValues() : read_settings(o.config_file);
  Config checked;
  update(checked, values);
  for (const auto& [name, value] : given_settings(o)) {
    values[name] = value;
  }
  return values;
}

TrackRequest make_request(const TrackOptions& o) {
  TrackRequest request = o.request;
  request.version = TELEMIME_VERSION;
  // From the defaults, so that a quality given here does not replace what the file sets.
  const SettingValues values = all_settings(o);
  request.config = Config();
  try {
    update(request.config, values);
  } catch (const Error& error) {
    throw Error(ErrorKind::usage, error.what());
  }
  return request;
}

}  // namespace telemime
