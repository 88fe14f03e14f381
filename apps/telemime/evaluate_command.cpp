// SPDX-License-Identifier: Apache-2.0
#include "commands.h"

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <cerrno>
#include <cmath>
#include <fstream>
#include <iostream>
#include <memory>
#include <string>
#include <system_error>

#include "telemime/core/errors.h"
#include "telemime/evaluation/evaluate.h"
#include "telemime/evaluation/report.h"
#include "telemime/evaluation/truth.h"
#include "telemime/outputs/readers/jsonl.h"

namespace telemime {
namespace {

struct EvaluateArguments {
  std::string pose;
  std::string truth;
  std::string json;
  EvaluationOptions options;
};

void write_json(const std::string& file, const Evaluation& evaluation) {
  errno = 0;
  std::ofstream stream(file);
  stream << evaluation_json(evaluation).dump(2, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
  stream.close();
  if (!stream) {
    throw Error(ErrorKind::output, "cannot write " + file + ": " + std::generic_category().message(errno),
                "give --json a file in a folder that you may write to, on a disk with free space");
  }
}

void run_evaluate(const EvaluateArguments& arguments) {
  if (!std::isfinite(arguments.options.max_region_score) ||
      !std::isfinite(arguments.options.max_contour_score)) {
    throw Error(ErrorKind::usage, "--max-f and --max-dc must be finite");
  }
  const PoseFile pose = read_pose_jsonl(arguments.pose);
  const Truth truth = read_truth(arguments.truth);
  const Evaluation evaluation = evaluate(pose.frames, pose.camera, truth, arguments.options);
  if (!pose.complaint.empty()) {
    std::cerr << "note: " << pose.complaint << '\n';
  }
  if (!arguments.options.by_time && has_variable_rate(pose.frames, truth.fps)) {
    std::cerr << "note: the times of the poses differ from those of the truth's frames of the same numbers; "
                 "--by-time compares frames of the same time\n";
  }
  std::cout << "poses  " << arguments.pose << '\n' << evaluation_table(evaluation) << std::flush;
  if (!arguments.json.empty()) {
    write_json(arguments.json, evaluation);
  }
}

}  // namespace

void add_evaluate_command(CLI::App& app) {
  const auto arguments = std::make_shared<EvaluateArguments>();
  CLI::App* const command = app.add_subcommand("evaluate", "Compare tracked poses with true joint positions");
  command->add_option("POSE", arguments->pose, "pose.jsonl of a run.")->required();
  command->add_option("--truth", arguments->truth, "truth.json of the same clip.")->required();
  command->add_option("--json", arguments->json, "Also write all measures to this file.");
  command->add_flag("--by-time", arguments->options.by_time,
                    "Compare frames of the same time, not of the same number: for recordings and videos of "
                    "variable rate.");
  command
      ->add_option("--max-f", arguments->options.max_region_score,
                   "Largest F of a frame that counts as tracked.")
      ->capture_default_str();
  command
      ->add_option("--max-dc", arguments->options.max_contour_score,
                   "Largest D_C of a frame that counts as tracked (pixels of the working image).")
      ->capture_default_str();
  command->callback([arguments] { run_evaluate(*arguments); });
}

}  // namespace telemime
