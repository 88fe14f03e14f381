// SPDX-License-Identifier: Apache-2.0
// The laboratory: each subcommand is one file in this folder.
#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <exception>
#include <iostream>

#include "cli/exit_codes.h"
#include "commands.h"
#include "telemime/capture/prepare_opencv.h"

int main(int argc, char** argv) {
  telemime::prepare_opencv();
  CLI::App app("Telemime's laboratory: experiments, synthetic clips, benchmarks, learning", "telemime-lab");
  app.require_subcommand(1);
  app.set_version_flag("--version", TELEMIME_VERSION);
  telemime::add_experiments_command(app);
  telemime::add_bench_command(app);
  telemime::add_synth_command(app);
  telemime::add_landmarks_command(app);
  telemime::add_learn_command(app);
  telemime::add_tune_command(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    const int code = app.exit(e, std::cout, std::cerr);
    return code == 0 ? 0 : telemime::kExitUsage;
  } catch (const telemime::Error& e) {
    std::cerr << "telemime-lab: " << e.what() << '\n';
    return telemime::exit_code(e.kind());
  } catch (const std::exception& e) {
    std::cerr << "telemime-lab: unexpected failure: " << e.what() << '\n';
    return telemime::kExitInternal;
  }
  return 0;
}
