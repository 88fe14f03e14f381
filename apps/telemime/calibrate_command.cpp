// SPDX-License-Identifier: Apache-2.0
#include "commands.h"

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <filesystem>
#include <iostream>
#include <memory>

#include "telemime/offline/track_file.h"
#include "track_options.h"

namespace telemime {
namespace {

struct CalibrateArguments {
  TrackOptions options;
  std::filesystem::path out;
};

void run(const CalibrateArguments& arguments) {
  RunHooks hooks;
  if (!arguments.options.quiet) {
    hooks.message = [](const std::string& words) { std::cerr << words << '\n'; };
  }
  const CalibratedPerson person = calibrate_file(make_request(arguments.options), hooks, arguments.out);
  if (arguments.options.quiet) {
    return;
  }
  std::cout << "calibrated: F " << person.score.region() << ", D_C " << person.score.contour()
            << " px; scale from " << person.scale_from << '\n';
  if (!person.refusal.empty()) {
    std::cout << "the arms keep average proportions: " << person.refusal << '\n';
  }
  std::cout << "written to " << arguments.out.string() << " and " << arguments.out.string()
            << ".scene.yml.gz\n";
}

}  // namespace

void add_calibrate_command(CLI::App& app) {
  const auto arguments = std::make_shared<CalibrateArguments>();
  CLI::App* command =
      app.add_subcommand("calibrate", "Fit the body to a person and save it for `track --calibration`");
  add_track_options(*command, arguments->options);
  command->add_option("--out", arguments->out, "File to write.")->default_val("calibration.json");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace telemime
