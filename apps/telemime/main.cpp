// SPDX-License-Identifier: Apache-2.0
// The program: every subcommand is one file beside this one.
#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <exception>
#include <iostream>

#include "avatar_command.h"
#include "bench_command.h"
#include "calibrate_command.h"
#include "config_command.h"
#include "evaluate_command.h"
#include "exit_codes.h"
#include "experiments_command.h"
#include "learn_command.h"
#include "live_command.h"
#include "synth_command.h"
#include "telemime/capture/quiet.h"
#include "track_command.h"
#include "tune_command.h"

int main(int argc, char** argv) {
  telemime::quiet_opencv();
  CLI::App app("Telemime: 3-D motion capture of the upper body from one camera", "telemime");
  app.require_subcommand(1);
  app.set_version_flag("--version", TELEMIME_VERSION);
  telemime::add_live_command(app);
  telemime::add_track_command(app);
  telemime::add_calibrate_command(app);
  telemime::add_evaluate_command(app);
  telemime::add_synth_command(app);
  telemime::add_tune_command(app);
  telemime::add_learn_command(app);
  telemime::add_bench_command(app);
  telemime::add_experiments_command(app);
  telemime::add_avatar_command(app);
  telemime::add_config_command(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    const int code = app.exit(e, std::cout, std::cerr);
    return code == 0 ? 0 : telemime::kExitUsage;
  } catch (const telemime::Interrupted&) {
    return telemime::kExitInterrupted;
  } catch (const telemime::Error& e) {
    std::cerr << "telemime: " << e.what() << '\n';
    return telemime::exit_code(e.kind());
  } catch (const std::exception& e) {
    std::cerr << "telemime: unexpected failure: " << e.what() << '\n';
    return telemime::kExitInternal;
  }
  return 0;
}
