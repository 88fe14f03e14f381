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
#include "lab/experiments/landmark_learning.h"
#include "lab/experiments/table.h"
#include "telemime/core/errors.h"
#include "telemime/nets/models/table.h"
#include "telemime/offline/run_outputs.h"

namespace telemime {
namespace {

struct FilterArguments {
  std::vector<std::string> folders;
  std::string out;
  std::string config;
};

void run_learn_filter(const FilterArguments& arguments) {
  Config config;
  if (!arguments.config.empty()) {
    update(config, read_settings(arguments.config));
  }
  prepare_file(arguments.out);
  std::vector<std::filesystem::path> clips(arguments.folders.begin(), arguments.folders.end());
  const FilterModel model =
      learn_filter_model(clips, config, [](const std::string& message) { std::cerr << message << '\n'; });
  std::string note = "estimated by telemime-lab learn filter from";
  for (const auto& clip : clips) {
    note += " " + (clip.has_filename() ? clip : clip.parent_path()).filename().string();
  }
  const std::string text = to_json_text(model, note);
  write_text(arguments.out, text);
  std::cout << text << "written to " << arguments.out << '\n';
}

struct LandmarkArguments {
  std::string models;
  std::string people;
  std::uint64_t seed = 101;
  int clips = 15;
};

// Clips of all gestures, near and far, half of them with a head that turns.
std::vector<SceneOptions> learning_scenes(const LandmarkArguments& arguments) {
  constexpr std::array kDistances = {0.0, 1.0, 0.75, 1.7};
  std::vector<SceneOptions> scenes(static_cast<std::size_t>(arguments.clips));
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    scenes[i] = {.gesture = gesture_named(kGestureNames[i % kGestureCount]),
                 .width = 320,
                 .height = 240,
                 .seed = arguments.seed + i,
                 .sensor = {},
                 .long_sleeves = i % 3 == 0,
                 .distance = kDistances[i % kDistances.size()],
                 .people = arguments.people,
                 .look_around = i % 2 == 0 ? 0.61 : 0.0};
  }
  return scenes;
}

void run_learn_landmarks(const LandmarkArguments& arguments) {
  const std::filesystem::path models = find_models(arguments.models);
  if (models.empty()) {
    throw Error(ErrorKind::config, "the networks are not installed",
                "build with npm, or name their folder with --models");
  }
  PersonFinder finder(models);
  std::vector<LearningFrame> frames;
  for (const SceneOptions& options : learning_scenes(arguments)) {
    std::cerr << "seed " << options.seed << ": " << kGestureNames[static_cast<std::size_t>(options.gesture)]
              << '\n';
    constexpr int kStep = 3;
    const auto clip = learning_frames(make_scene(options), kStep, finder);
    frames.insert(frames.end(), clip.begin(), clip.end());
  }
  const LearnedLandmarks learned = learn_landmarks(frames);
  Table points{"landmarks", {"landmark", "", "x", "y", "z", "sigma", "seen"}, {}};
  for (std::size_t i = 0; i < kLandmarkCount; ++i) {
    const LandmarkPoint& now = kLandmarkPoints[i];
    const LearnedLandmarks::Point& point = learned.points[i];
    const char* source = now.source == OffsetSource::learned ? "table" : "table (anthropometry)";
    points.rows.push_back(
        row_of(now.name, source, now.offset[0], now.offset[1], now.offset[2], now.sigma, ""));
    points.rows.push_back(
        row_of("", "learned", point.offset[0], point.offset[1], point.offset[2], point.sigma, point.count));
    points.rows.push_back(row_of("", "+-", point.error[0], point.error[1], point.error[2], "", ""));
  }
  Table bones{"bones", {"bone", "sigma in the table", "learned"}, {}};
  for (std::size_t i = 0; i < kLandmarkBoneCount; ++i) {
    bones.rows.push_back(row_of(i, kLandmarkBoneSigma[i], learned.bone_sigma[i]));
  }
  std::cout << to_text(points) << '\n' << to_text(bones);
}

void add_filter_command(CLI::App& learn) {
  const auto arguments = std::make_shared<FilterArguments>();
  CLI::App* const command =
      learn.add_subcommand("filter", "The particle filter's parameters, from sequences with known truth");
  command
      ->add_option("FOLDER", arguments->folders,
                   "folders with video, background and truth.json, as `synth` makes them")
      ->required();
  command->add_option("--out", arguments->out, "JSON file for the setting filter.model")->required();
  command->add_option("--config", arguments->config, "JSON file of settings for the tracking");
  command->callback([arguments] { run_learn_filter(*arguments); });
}

void add_landmarks_command_of(CLI::App& learn) {
  const auto arguments = std::make_shared<LandmarkArguments>();
  CLI::App* const command = learn.add_subcommand(
      "landmarks", "Where networks see the landmarks of the model, and how well, from synthetic clips");
  command->add_option("--models", arguments->models, "folder of the networks [those of the program]");
  command->add_option("--people", arguments->people,
                      "people of meshes instead of drawn ones; the folder that apps/lab/people.sh prints");
  command->add_option("--seed", arguments->seed, "of the first clip")->capture_default_str();
  command->add_option("--clips", arguments->clips, "number of clips, each of another person")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
  command->callback([arguments] { run_learn_landmarks(*arguments); });
}

}  // namespace

void add_learn_command(CLI::App& app) {
  CLI::App* const command = app.add_subcommand("learn", "Estimate numbers of the program from known truth");
  command->require_subcommand(1);
  add_filter_command(*command);
  add_landmarks_command_of(*command);
}

}  // namespace telemime
