// SPDX-License-Identifier: Apache-2.0
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "commands.h"
#include "lab/experiments/experiments.h"
#include "telemime/offline/run_outputs.h"

namespace telemime {
namespace {

struct LearnArguments {
  std::vector<std::string> folders;
  std::string out;
  std::string config;
};

void run_learn(const LearnArguments& arguments) {
  Config config;
  if (!arguments.config.empty()) {
    update(config, read_settings(arguments.config));
  }
  prepare_file(arguments.out);
  std::vector<std::filesystem::path> clips(arguments.folders.begin(), arguments.folders.end());
  const FilterModel model =
      learn_filter_model(clips, config, [](const std::string& message) { std::cerr << message << '\n'; });
  std::string note = "estimated by telemime-lab learn from";
  for (const auto& clip : clips) {
    note += " " + (clip.has_filename() ? clip : clip.parent_path()).filename().string();
  }
  const std::string text = to_json_text(model, note);
  write_text(arguments.out, text);
  std::cout << text << "written to " << arguments.out << '\n';
}

}  // namespace

void add_learn_command(CLI::App& app) {
  const auto arguments = std::make_shared<LearnArguments>();
  CLI::App* const command = app.add_subcommand(
      "learn", "Estimate the particle filter's parameters from sequences with known truth");
  command
      ->add_option("FOLDER", arguments->folders,
                   "folders with video, background and truth.json, as `synth` makes them")
      ->required();
  command->add_option("--out", arguments->out, "JSON file for the setting filter.model")->required();
  command->add_option("--config", arguments->config, "JSON file of settings for the tracking");
  command->callback([arguments] { run_learn(*arguments); });
}

}  // namespace telemime
