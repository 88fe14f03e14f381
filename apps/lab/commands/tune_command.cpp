// SPDX-License-Identifier: Apache-2.0
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <array>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "commands.h"
#include "lab/experiments/budget_fit.h"
#include "lab/experiments/experiments.h"
#include "telemime/likelihood/all.h"
#include "telemime/tracker/config.h"

namespace telemime {
namespace {

struct TuneArguments {
  std::string out;
  std::string fit;
  double budget_ms = 10.0;
};

void run_tune(const TuneArguments& arguments) {
  const QuadraticFit fit = arguments.fit.empty() ? default_fit() : read_fit(arguments.fit);
  std::vector<EvaluationCost> costs;
  const Model model = make_model(Shape{});
  const auto backend = make_backend(Config{}.backend);
  Table table{"", {"size", "F us", "D_C us", "region iterations", "edge iterations"}, {}};
  constexpr int kRepeats = 15;
  for (const auto& [width, height] : {std::array{160, 120}, std::array{320, 240}, std::array{640, 480}}) {
    Random random(1);
    const EvaluationCost cost =
        measure_cost(*backend, model, Camera{}.scaled_to(width, height), kRepeats, random, thread_seconds);
    costs.push_back(cost);
    const Split split = split_for_budget(arguments.budget_ms, cost.region_ms, cost.edge_ms, fit);
    table.rows.push_back(
        row_of(size_name(width, height), 1e3 * cost.region_ms, 1e3 * cost.edge_ms, split.region, split.edge));
  }
  std::cout << "best split of " << number(arguments.budget_ms) << " ms of search per frame\n"
            << to_text(table);
  if (!arguments.out.empty()) {
    write_text(arguments.out, tuning_json(fit, costs, arguments.budget_ms));
    std::cout << "written to " << arguments.out << '\n';
  }
}

}  // namespace

void add_tune_command(CLI::App& app) {
  const auto arguments = std::make_shared<TuneArguments>();
  CLI::App* const command =
      app.add_subcommand("tune", "Measure this machine and split a time budget between regions and edges");
  command->add_option("--out", arguments->out, "also write costs and splits to this JSON file");
  command->add_option("--budget", arguments->budget_ms, "search time per frame, ms")
      ->capture_default_str()
      ->check(CLI::Range(0.01, 1e5));
  command->add_option("--fit", arguments->fit, "file of fitted coefficients [data/budget.json]");
  command->callback([arguments] { run_tune(*arguments); });
}

}  // namespace telemime
