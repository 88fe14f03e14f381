// SPDX-License-Identifier: Apache-2.0
#include "commands.h"

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <iostream>
#include <memory>

#include "telemime/tracker/config.h"
#include "track_options.h"

namespace telemime {

void add_config_command(CLI::App& app) {
  const auto options = std::make_shared<TrackOptions>();
  const auto name = std::make_shared<std::string>();
  CLI::App* const command = app.add_subcommand("config", "Print the settings as JSON, or explain them");
  CLI::Option* const explain_option = command->add_option(
      "--explain", *name, "Explain this setting or group as a table; without a name: all settings.");
  explain_option->expected(0, 1);
  add_setting_options(*command, *options);
  command->callback([options, name, explain_option] {
    Config config = make_request(*options).config;
    if (explain_option->count() > 0) {
      std::cout << explain(settings_of(config), *name);
    } else {
      std::cout << to_json(config).dump(2) << '\n';
    }
  });
}

}  // namespace telemime
