// SPDX-License-Identifier: Apache-2.0
// The program: every subcommand is one file beside this one.
#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <memory>

#include "cli/exit_codes.h"
#include "commands.h"
#include "reference.h"
#include "telemime/capture/prepare_opencv.h"

#ifdef TELEMIME_MEETING
#include "cli/data_folder.h"
#include "meeting/commands/commands.h"
#include "telemime/live/live_files.h"
#include "telemime/streaming/avatar_folder.h"
#endif

namespace telemime {
namespace {

#ifdef TELEMIME_MEETING
/// The files that `telemime meeting` serves: the page in this program, its avatars, and those of a folder of
/// the user (empty: none). Throws Error(usage) when the folder cannot be read.
meeting::MeetingFiles meeting_files(const std::filesystem::path& more) {
  const AvatarFolder avatars(avatar_folder(), more);
  return {.looks = avatars.looks(),
          .get = [avatars](const std::string& path) { return room_file(path, avatars); }};
}
#endif

int exit_code_of(int argc, char** argv, const LeftBehind& left_behind) {
  CLI::App app("Telemime: 3-D motion capture of the upper body from one camera", "telemime");
  app.require_subcommand(0, 1);
  app.set_version_flag("--version", TELEMIME_VERSION);
  add_live_command(app, left_behind);
#ifdef TELEMIME_MEETING
  meeting::add_meeting_command(app, meeting_files);
#endif
  add_track_command(app);
  add_calibrate_command(app);
  add_evaluate_command(app);
  add_avatar_command(app);
  add_config_command(app);
  add_doctor_command(app);
  // Without a group it is in no help text: the build calls it.
  const auto write = [&app](const std::string& folder) {
    write_reference(app, folder, TELEMIME_VERSION);
    throw CLI::Success();
  };
  app.add_option_function<std::string>("--write-reference", write, "Folder of manual pages and completion.")
      ->group("");
  try {
    app.parse(argc, argv);
    if (app.get_subcommands().empty()) {
      print_first_steps(std::cout);
    }
  } catch (const CLI::ParseError& e) {
    const int code = app.exit(e, std::cout, std::cerr);
    return code == 0 ? 0 : kExitUsage;
  } catch (const ToldAlready& told) {
    return told.code();
  } catch (const Interrupted&) {
    return kExitInterrupted;
  } catch (const Error& e) {
    std::cerr << "telemime: " << e.what() << '\n';
    return exit_code(e.kind());
  } catch (const std::exception& e) {
    std::cerr << "telemime: unexpected failure: " << e.what() << '\n';
    return kExitInternal;
  }
  return 0;
}

}  // namespace
}  // namespace telemime

int main(int argc, char** argv) {
  telemime::prepare_opencv();
  const auto left_behind = std::make_shared<std::atomic<bool>>(false);
  const int code = telemime::exit_code_of(argc, argv, left_behind);
  if (*left_behind) {
    // A thread still hangs in FFmpeg or a driver: static objects must not be destroyed while it runs.
    std::cout.flush();
    std::cerr.flush();
    std::fflush(nullptr);
    std::_Exit(code);
  }
  return code;
}
