// SPDX-License-Identifier: Apache-2.0
#include "experiments_command.h"

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

#include "lab/experiments/all.h"
#include "measurement_clips.h"
#include "telemime/core/errors.h"
#include "thread_clock.h"

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
  std::vector<const Experiment*> experiments;
  for (const std::string& id : ids) {
    if (id == "all") {
      for (const Experiment& experiment : kExperiments) {
        experiments.push_back(&experiment);
      }
    } else if (const Experiment* const found = find_experiment(id)) {
      experiments.push_back(found);
    } else {
      throw Error(ErrorKind::usage, "there is no experiment '" + id + "'",
                  "`telemime experiments list` names them all.");
    }
  }
  return experiments;
}

void list_experiments() {
  Table table{"", {"id", "what"}, {}};
  for (const Experiment& experiment : kExperiments) {
    table.rows.push_back({std::string(experiment.id), std::string(experiment.title)});
  }
  std::cout << to_text(table);
}

void run_experiments(ExperimentArguments arguments) {
  if (arguments.ids.size() == 1 && arguments.ids.front() == "list") {
    list_experiments();
    return;
  }
  const auto experiments = chosen(arguments.ids);
  cv::setNumThreads(1);  // experiments run side by side instead
  const auto start = std::chrono::steady_clock::now();
  const auto elapsed = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  arguments.lab.data = measurement_data(arguments.data, arguments.out);
  arguments.lab.seconds = thread_seconds;
  arguments.lab.progress = [&](const std::string& words) {
    std::cerr << '[' << static_cast<int>(elapsed()) << " s] " << words << '\n';
  };
  Lab lab(arguments.lab);
  std::vector<Section> sections;
  const std::filesystem::path out = arguments.out;
  std::string missed;
  ErrorKind why = ErrorKind::tracking;
  // What one experiment cannot use need not stop hours of others.
  const auto try_to = [&](std::string_view id, const std::function<void()>& measure) {
    const auto miss = [&](const char* words, ErrorKind kind) {
      std::cerr << id << "  not measured: " << words << '\n';
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
  for (const Experiment* const experiment : experiments) {
    if (!try_to(experiment->id, [&] { sections.push_back(run_experiment(*experiment, lab)); })) {
      continue;
    }
    write_section(out, sections.back());
    std::cout << experiment->id << "  " << sections.back().finding.verdict << std::endl;
    write_text(out / "report.html", report_page(sections, conditions(lab.options())));
  }
  if (!arguments.budget.empty()) {
    try_to("--budget", [&] { write_text(arguments.budget, tuning_json({lab.fit(), {}}, 0.0)); });
  }
  if (!sections.empty()) {
    std::cout << "report: " << (out / "report.html").string() << '\n';
  }
  if (!missed.empty()) {
    throw Error(why, "experiments that could not be measured:" + missed);
  }
}

}  // namespace

void add_experiments_command(CLI::App& app) {
  const auto arguments = std::make_shared<ExperimentArguments>();
  CLI::App* const command =
      app.add_subcommand("experiments", "Measure tables and figures of the thesis again");
  command->add_option("ID", arguments->ids, "which ones: list, all, or ids such as F3-18")->required();
  command->add_option("--data", arguments->data,
                      "folder with raising_arms, joy, exclaiming, asking [the development clips, or made]");
  command->add_option("--out", arguments->out, "folder of the results")->capture_default_str();
  command->add_option("--seed", arguments->lab.seed, "of every random draw")->capture_default_str();
  command->add_option("--seeds", arguments->lab.seeds, "runs of each particle filter [5; 2 with --quick]")
      ->check(CLI::Range(1, 1000));
  command->add_option("--write-budget", arguments->budget,
                      "also write the coefficients of F3-28 to this file (data/budget.json)");
  command->add_flag("--quick", arguments->lab.quick, "few frames, coarse grids: about a minute");
  command->callback([arguments] { run_experiments(*arguments); });
}

}  // namespace telemime
