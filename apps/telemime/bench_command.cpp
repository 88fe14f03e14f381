// SPDX-License-Identifier: Apache-2.0
#include "bench_command.h"

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <array>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "measurement_clips.h"
#include "telemime/experiments/report.h"
#include "telemime/experiments/timing.h"
#include "thread_clock.h"

namespace telemime {
namespace {

struct BenchArguments {
  std::string json;
  std::string data;
  std::string out = "out/experiments";
  LabOptions lab;
};

nlohmann::json to_json(const Table& table) {
  nlohmann::json rows = nlohmann::json::array();
  for (const auto& row : table.rows) {
    nlohmann::json entry;
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      entry[table.columns[c]] = row[c];
    }
    rows.push_back(entry);
  }
  return {{"title", table.title}, {"rows", rows}};
}

void run_bench(BenchArguments arguments) {
  cv::setNumThreads(1);
  arguments.lab.data = measurement_data(arguments.data, arguments.out);
  arguments.lab.seconds = thread_seconds;
  Lab lab(arguments.lab);
  constexpr std::array<int, 6> kIterations = {40, 100, 200, 300, 400, 500};
  const std::vector<FrameTime> frames = measure_frame_times(lab, kIterations);
  const std::vector<SizeTime> sizes = measure_sizes(lab);
  const std::vector<Table> tables = {background_time_table(lab), frame_time_table(frames),
                                     size_time_table(sizes)};
  nlohmann::json json = nlohmann::json::array();
  for (const Table& table : tables) {
    std::cout << to_text(table) << '\n';
    json.push_back(to_json(table));
  }
  std::cout << "one thread, computing time, medians; 500 evaluations at 160x120: "
            << number(1e3 / frames.back().total_ms()) << " frames a second\n";
  if (!arguments.json.empty()) {
    write_text(arguments.json, json.dump(2) + "\n");
  }
}

}  // namespace

void add_bench_command(CLI::App& app) {
  const auto arguments = std::make_shared<BenchArguments>();
  CLI::App* const command =
      app.add_subcommand("bench", "Time features, evaluations and frames beside the thesis's tables");
  command->add_option("--json", arguments->json, "also write the tables to this file");
  command->add_option("--data", arguments->data, "folder with joy [the development clips, or made]");
  command->add_option("--out", arguments->out, "folder for clips that have to be made")
      ->capture_default_str();
  command->add_flag("--quick", arguments->lab.quick, "fewer frames and repeats");
  command->callback([arguments] { run_bench(*arguments); });
}

}  // namespace telemime
