// SPDX-License-Identifier: Apache-2.0
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "commands.h"
#include "lab/experiments/engine.h"
#include "lab/experiments/experiments.h"
#include "telemime/core/errors.h"
#include "telemime/likelihood/all.h"
#include "telemime/nets/face_landmarks.h"
#include "telemime/nets/models/table.h"

namespace telemime {
namespace {

struct BenchArguments {
  std::string json;
  std::string data;
  std::string out = "out/experiments";
  std::vector<std::string> backends;
  bool engine_only = false;
  double soak_minutes = 0.0;
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

// The tables of the thesis's computing times, which need clips.
void report_clips(BenchArguments& arguments, const std::function<void(const Table&)>& show) {
  arguments.lab.data = measurement_data(arguments.data, arguments.out);
  arguments.lab.seconds = thread_seconds;
  Lab lab(arguments.lab);
  const std::vector<FrameTime> frames = measure_frame_times(lab);
  const std::vector<SizeTime> sizes = measure_sizes(lab);
  show(background_time_table(lab));
  show(frame_time_table(frames));
  show(size_time_table(sizes));
  std::cout << "one thread, processor time, medians; 500 evaluations at 160x120: "
            << number(1e3 / frames.back().total_ms()) << " frames per second\n";
}

// Processor time of one run of each network that is installed.
Table network_time_table(const std::filesystem::path& models) {
  constexpr int kRuns = 20;
  Table table{
      .title = "networks, one thread, processor time, medians", .columns = {"network", "ms"}, .rows = {}};
  for (const ModelFile& model : model_table()) {
    // The details of a face are other networks in the same file.
    const bool face = model.name == "face_landmark_with_attention";
    Network network = load_network(
        models, model.name, {.inputs = {}, .outputs = face ? kFaceMeshOutputs : std::vector<std::string>()});
    const std::vector<float> input(element_count(network.input_shape()), 0.5F);
    std::vector<double> times;
    for (int i = 0; i < kRuns; ++i) {
      const double start = thread_seconds();
      network.run(input);
      times.push_back(1e3 * (thread_seconds() - start));
    }
    table.rows.push_back({std::string(model.name), number(median_of(times))});
  }
  return table;
}

// Measures the evaluation engine; passes each table to `show` as soon as it is complete.
void report_engine(const EngineOptions& options, const std::function<void(const Table&)>& show) {
  const std::vector<std::string> backends = engine_backends(options);
  for (const std::string& line : missing_backends()) {
    std::cout << "not measured, cannot run here: " << line << '\n';
  }
  const std::vector<Throughput> cells = measure_throughput(options);
  show(speed_table(cells));
  show(time_table(cells));
  if (const Table device = device_table(cells); !device.rows.empty()) {
    show(device);
  }
  const auto measured = [&](const char* name) {
    return std::find(backends.begin(), backends.end(), name) != backends.end();
  };
  if (measured("scalar")) {
    show(scalar_stage_table(options));
  }
  if (measured("simd")) {
    show(simd_stage_table(options));
    show(instruction_set_table(options));
    show(opencv_table(options));
  }
  show(overlap_time_table(options));
  if (backends.size() > 1 || backends.front() != "scalar") {
    show(agreement_table(options));
    show(ranking_table(options));
  }
  std::cout << "wall-clock time, best of several; '-': would take too long\n";
}

void run_bench(BenchArguments arguments) {
  cv::setNumThreads(1);
  if (arguments.soak_minutes > 0.0) {
    run_soak(arguments.soak_minutes);
    return;
  }
  EngineOptions engine;
  engine.backends = arguments.backends;
  engine.quick = arguments.lab.quick;
  engine.seed = arguments.lab.seed;
  engine.seconds = steady_seconds;
  // Unknown names and a file that cannot be written are refused before anything is measured; the file keeps
  // what it has.
  engine_backends(engine);
  if (!arguments.json.empty() && !std::ofstream(arguments.json, std::ios::app)) {
    throw Error(ErrorKind::output, "cannot write " + arguments.json, "give --json a writable file");
  }
  nlohmann::json json = nlohmann::json::array();
  const auto show = [&](const Table& table) {
    std::cout << to_text(table) << std::endl;
    json.push_back(to_json(table));
  };
  if (!arguments.engine_only) {
    if (const std::filesystem::path models = find_models(); !models.empty()) {
      show(network_time_table(models));
    } else {
      std::cout << "not measured, not installed: the networks\n";
    }
    report_clips(arguments, show);
    std::cout << '\n';
  }
  report_engine(engine, show);
  if (!arguments.json.empty()) {
    write_text(arguments.json, json.dump(2) + "\n");
  }
}

}  // namespace

void add_bench_command(CLI::App& app) {
  const auto arguments = std::make_shared<BenchArguments>();
  CLI::App* const command = app.add_subcommand(
      "bench", "Time features, evaluations and frames beside the thesis's tables, and time the back ends");
  CLI::Option* const json =
      command->add_option("--json", arguments->json, "also write the tables to this file");
  command->add_option("--data", arguments->data,
                      "folder with the clip joy [the development clips, else made]");
  command->add_option("--out", arguments->out, "folder for clips that have to be made")
      ->capture_default_str();
  command->add_flag("--quick", arguments->lab.quick, "fewer frames, poses and repeats");
  command->add_option("--backend", arguments->backends, "measure only this back end; may be repeated");
  command->add_flag("--engine-only", arguments->engine_only, "only the back ends; needs no clips");
  command
      ->add_option("--soak", arguments->soak_minutes,
                   "instead, evaluate for this many minutes and watch the memory")
      ->check(CLI::Range(0.01, 1e5))
      ->excludes(json);
  command->callback([arguments] { run_bench(*arguments); });
}

}  // namespace telemime
