// SPDX-License-Identifier: Apache-2.0
#include "tune_command.h"

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <array>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>

#include "telemime/core/errors.h"
#include "telemime/experiments/report.h"
#include "telemime/registration/budget.h"
#include "thread_clock.h"

namespace telemime {
namespace {

struct TuneArguments {
  std::string out;
  std::string fit;
  double budget_ms = 10.0;
};

// The fitted coefficients: given, or beside the sources, or installed beside the program.
std::filesystem::path fit_file(const std::string& given) {
  if (!given.empty()) {
    return given;
  }
  std::error_code failure;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", failure).parent_path();
  const std::array<std::filesystem::path, 4> places = {
      "data/budget.json", program / "../share/telemime/budget.json", program / "../data/budget.json",
      program / "../../data/budget.json"};
  for (const auto& place : places) {
    if (std::filesystem::exists(place)) {
      return place;
    }
  }
  throw Error(ErrorKind::config, "data/budget.json was not found", "Give it with --fit FILE.");
}

void run_tune(const TuneArguments& arguments) {
  Tuning tuning = read_tuning(fit_file(arguments.fit));
  tuning.costs.clear();
  const Model model = make_model(Shape{});
  const auto backend = make_scalar_backend();
  Table table{"", {"size", "F us", "D_C us", "region iterations", "edge iterations"}, {}};
  constexpr int kRepeats = 15;
  for (const auto& [width, height] : {std::array{160, 120}, std::array{320, 240}, std::array{640, 480}}) {
    Random random(1);
    const EvaluationCost cost =
        measure_cost(*backend, model, Camera{}.scaled_to(width, height), kRepeats, random, thread_seconds);
    tuning.costs.push_back(cost);
    const Split split = split_for_budget(arguments.budget_ms, cost.region_ms, cost.edge_ms, tuning.fit);
    table.rows.push_back({std::to_string(width) + "x" + std::to_string(height), number(1e3 * cost.region_ms),
                          number(1e3 * cost.edge_ms), std::to_string(split.region),
                          std::to_string(split.edge)});
  }
  std::cout << "best split of " << number(arguments.budget_ms) << " ms a frame for the search\n"
            << to_text(table);
  if (!arguments.out.empty()) {
    write_text(arguments.out, tuning_json(tuning, arguments.budget_ms));
    std::cout << "written to " << arguments.out << '\n';
  }
}

}  // namespace

void add_tune_command(CLI::App& app) {
  const auto arguments = std::make_shared<TuneArguments>();
  CLI::App* const command =
      app.add_subcommand("tune", "Measure this machine and split a time budget between regions and edges");
  command->add_option("--out", arguments->out, "also write costs and splits to this JSON file");
  command->add_option("--budget", arguments->budget_ms, "search time a frame, ms")
      ->capture_default_str()
      ->check(CLI::Range(0.01, 1e5));
  command->add_option("--fit", arguments->fit, "file of fitted coefficients [data/budget.json]");
  command->callback([arguments] { run_tune(*arguments); });
}

}  // namespace telemime
