// SPDX-License-Identifier: Apache-2.0
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <chrono>
#include <exception>
#include <functional>
#include <iostream>
#include <memory>
#include <opencv2/core.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "commands.h"
#include "lab/experiments/experiments.h"
#include "lab/synth/sequence.h"
#include "telemime/core/errors.h"

namespace telemime {
namespace {

struct ExperimentArguments {
  std::vector<std::string> ids;
  std::string data;
  std::string out = "out/experiments";
  std::string budget;
  LabOptions lab;
};

std::vector<const Experiment*> chosen(const std::vector<std::string>& ids) {
  std::vector<const Experiment*> selected;
  for (const std::string& id : ids) {
    if (id == "all") {
      for (const Experiment& experiment : experiments()) {
        selected.push_back(&experiment);
      }
    } else if (const Experiment* const found = find_experiment(id)) {
      selected.push_back(found);
    } else {
      throw Error(ErrorKind::usage, "there is no experiment '" + id + "'",
                  "`telemime-lab experiments list` lists them.");
    }
  }
  return selected;
}

void list_experiments() {
  Table table{"", {"id", "what"}, {}};
  for (const Experiment& experiment : experiments()) {
    table.rows.push_back({std::string(experiment.id), std::string(experiment.title)});
  }
  std::cout << to_text(table);
}

void run_experiments(ExperimentArguments arguments) {
  if (arguments.ids.size() == 1 && arguments.ids.front() == "list") {
    list_experiments();
    return;
  }
  const auto selected = chosen(arguments.ids);
  cv::setNumThreads(1);  // experiments run side by side instead
  const auto start = std::chrono::steady_clock::now();
  const auto elapsed = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  arguments.lab.data = measurement_data(arguments.data, arguments.out);
  arguments.lab.seconds = thread_seconds;
  arguments.lab.progress = [&](const std::string& message) {
    std::cerr << '[' << static_cast<int>(elapsed()) << " s] " << message << '\n';
  };
  Lab lab(arguments.lab);
  const std::filesystem::path out = arguments.out;
  std::string missed;
  ErrorKind why = ErrorKind::tracking;
  // An experiment that fails does not stop hours of others.
  const auto try_to = [&](std::string_view id, const std::function<void()>& measure) {
    const auto miss = [&](const char* reason, ErrorKind kind) {
      std::cerr << id << "  not measured: " << reason << '\n';
      why = missed.empty() ? kind : why;
      missed.append(" ").append(id);
      return false;
    };
    try {
      measure();
      return true;
    } catch (const Error& error) {
      return miss(error.what(), error.kind());
    } catch (const std::exception& error) {
      return miss(error.what(), ErrorKind::tracking);
    }
  };
  for (const Experiment* const experiment : selected) {
    Section section;
    if (!try_to(experiment->id, [&] { section = run_experiment(*experiment, lab); })) {
      continue;
    }
    write_section(out, section);
    std::cout << experiment->id << "  " << section.finding.verdict << std::endl;
  }
  if (!arguments.budget.empty()) {
    try_to("--budget", [&] { write_text(arguments.budget, tuning_json(lab.fit())); });
  }
  std::string head;
  for (const std::string& line : conditions(lab.options())) {
    head += line + "\n";
  }
  write_text(out / "conditions.txt", head);
  std::cout << "results: " << out.string() << "; apps/lab/plots.py " << out.string()
            << " draws the figures and writes report.html there\n";
  if (!missed.empty()) {
    throw Error(why, "these experiments could not be measured:" + missed);
  }
}

}  // namespace

std::filesystem::path measurement_data(const std::filesystem::path& given, const std::filesystem::path& out) {
  if (!given.empty()) {
    return given;
  }
  std::filesystem::path development = "../shared/data/dev";
  if (std::filesystem::exists(development / "joy" / "truth.json")) {
    return development;
  }
  std::filesystem::path made = out / "clips";
  for (const std::string_view name : kThesisGestures) {
    if (std::filesystem::exists(made / name / kPreview)) {  // which is written last
      continue;
    }
    std::cerr << "making the clip " << name << '\n';
    SequenceOptions options;
    options.scene.gesture = gesture_named(std::string(name));
    options.scene.width = 320;
    options.scene.height = 240;
    options.folder = made;
    options.small_videos = false;
    make_sequence(options);
  }
  return made;
}

void add_experiments_command(CLI::App& app) {
  const auto arguments = std::make_shared<ExperimentArguments>();
  CLI::App* const command =
      app.add_subcommand("experiments", "Measure the tables and figures of the thesis again");
  command->add_option("ID", arguments->ids, "list, all, or ids such as F3-18")->required();
  command->add_option("--data", arguments->data,
                      "folder with raising_arms, joy, exclaiming, asking [the development clips, else made]");
  command->add_option("--out", arguments->out, "folder of the results")->capture_default_str();
  command->add_option("--seed", arguments->lab.seed, "seed of every random draw")->capture_default_str();
  command
      ->add_option("--seeds", arguments->lab.seeds,
                   "number of runs of each particle filter [5; 2 with --quick]")
      ->check(CLI::Range(1, 1000));
  CLI::Option* const budget =
      command->add_option("--write-budget", arguments->budget,
                          "also write the coefficients of F3-28 to this file (data/budget.json)");
  command->add_flag("--quick", arguments->lab.quick, "few frames, coarse grids: about a minute")
      ->excludes(budget);
  command->callback([arguments] { run_experiments(*arguments); });
}

}  // namespace telemime
