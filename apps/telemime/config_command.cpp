// SPDX-License-Identifier: Apache-2.0
#include "config_command.h"

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <iostream>

#include "telemime/tracker/config.h"

namespace telemime {

void add_config_command(CLI::App& app) {
  app.add_subcommand("config", "Print all settings with their defaults as JSON")->callback([] {
    std::cout << to_json(Config()).dump(2) << '\n';
  });
}

}  // namespace telemime
