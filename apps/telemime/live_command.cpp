// SPDX-License-Identifier: Apache-2.0
#include "commands.h"

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <memory>
#include <mutex>
#include <opencv2/core/utility.hpp>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

#include "cli/data_folder.h"
#include "cli/interrupt.h"
#include "open_page.h"
#include "telemime/capture/playback.h"
#include "telemime/core/errors.h"
#include "telemime/live/live_program.h"
#include "telemime/live/pace.h"
#include "telemime/live/video_output.h"
#include "track_options.h"

#ifdef TELEMIME_MEETING
#include "meeting/transport/senders.h"
#endif

namespace telemime {
namespace {

// A page that is reloaded is back within this time.
constexpr std::chrono::seconds kReload{3};
// Time for a browser to start and show the page.
constexpr std::chrono::seconds kFirstPage{30};

struct LiveCommand {
  TrackOptions track;
  LiveRequest live;
  bool guided = false;
  bool unguided = false;
  bool open = false;
  bool no_settings = false;
  bool loop = false;
  double seconds = 0.0;
};

// Opens the input as a camera. Records whether it is a file: then nobody can be asked to leave the image.
std::unique_ptr<Source> open_live(LiveCommand& command, const LeftBehind& left_behind) {
  LiveOptions options;
  options.input = command.live.request.input_options;
  options.left_behind = [left_behind] { *left_behind = true; };
  LiveInput input = open_live_input(command.live.request.input, options, command.loop);
  command.live.camera = input.camera;
  command.live.ends = !input.camera && !command.loop;
  // If networks find the person, nobody needs to leave the image.
  const bool needed = !uses_networks(command.live.request.config);
  command.live.guided = input.camera && !command.unguided && (command.guided || needed);
  return std::move(input.source);
}

void print_report(const LiveReport& report) {
  const LiveRates& r = report.state.rates;
  std::cout << std::fixed << std::setprecision(1) << r.frames << " frames, " << r.dropped << " dropped, "
            << r.tracked << " per second\n"
            << "From camera to pose: " << r.ms.total << " ms (95 %: " << r.ms.total_p95 << "), of which wait "
            << r.ms.wait << ", features " << r.ms.features << ", queue " << r.ms.queue << ", search "
            << r.ms.search << '\n';
  if (report.latency) {
    std::cout << "From camera to drawn avatar, measured by the page: " << report.latency->median
              << " ms (95 %: " << report.latency->p95 << ")\n";
  }
  std::cout << std::setprecision(2) << "Processor load: " << report.cpu << " cores\n";
  for (const SenderStatus& s : report.outputs) {
    std::cout << s.url << ": " << s.sent << " frames sent, " << s.dropped << " dropped"
              << (s.words.empty() ? "" : "; " + s.words) << '\n';
  }
}

// Waits until the user stops the program, the time is over, or nothing can be tracked any more because the
// input has ended or something has failed. Users of the page may still want its recordings: while a page is
// open, the program keeps running.
void wait_for_end(const LiveCommand& command, const LiveProgram& program, const LiveProgram::Message& say) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  auto last_use = start;
  bool expected = command.open;  // a page that has not come yet
  bool told = false;
  while (!interrupted()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    const auto now = Clock::now();
    if (command.seconds > 0.0 && std::chrono::duration<double>(now - start).count() >= command.seconds) {
      return;
    }
    const LiveReport report = program.report();
    const bool ended = report.state.phase == LivePhase::ended;
    expected = expected && report.pages == 0;
    if (!ended || report.pages > 0) {
      last_use = now;
    } else if (now - last_use > (expected ? kFirstPage : kReload)) {
      return;
    }
    if (ended && !std::exchange(told, true)) {
      const std::string stays = report.pages > 0 ? "the program keeps running while a page is open" : "";
      const std::string words = report.failure  ? stays
                                : stays.empty() ? "the input has ended"
                                                : "the input has ended; " + stays;
      if (!words.empty()) {
        say(MessageLevel::info, words);
      }
    }
  }
}

// The XDG Base Directory Specification: relative paths are ignored.
std::filesystem::path settings_file() {
  const auto folder = [](const char* variable) {
    const char* const value = std::getenv(variable);
    const std::filesystem::path path(value == nullptr ? "" : value);
    return path.is_absolute() ? path : std::filesystem::path();
  };
  if (const auto config = folder("XDG_CONFIG_HOME"); !config.empty()) {
    return config / "telemime" / "live.json";
  }
  const auto home = folder("HOME");
  return home.empty() ? home : home / ".config" / "telemime" / "live.json";
}

// Exit code of a run that ended by itself.
void fail(const LiveFailure& failure) {
  if (failure.input) {
    throw Error(ErrorKind::input, "the run ended: " + failure.words);
  }
  throw std::runtime_error(failure.words);
}

void run(LiveCommand command, const LeftBehind& left_behind) {
  if (command.track.request.input == "demo") {
    const auto demo = data_folder() / "demo";
    command.track.request.input = (demo / "video.mp4").string();
    command.track.request.background = command.track.request.background.empty()
                                           ? (demo / "background.mp4").string()
                                           : command.track.request.background;
    command.loop = true;
  }
  command.live.request = make_request(command.track);
  command.live.request.keep_pace = keeps_pace(all_settings(command.track));
  command.live.version = TELEMIME_VERSION;
  command.live.avatars = avatar_folder();
  command.live.settings = command.no_settings ? std::filesystem::path() : settings_file();
  std::mutex mutex;
  const auto say = [&mutex, quiet = command.track.quiet](MessageLevel level, const std::string& words) {
    if (!quiet || level != MessageLevel::info) {
      const std::lock_guard lock(mutex);
      std::cerr << words << '\n';
    }
  };
  // OpenCV's loops over such small images gain nothing from threads, and the waiting threads take processor
  // time from the search and the page.
  cv::setNumThreads(1);
  // Nothing is lost before the input is open, so Ctrl-C need not wait for a camera or a network.
  if (!command.live.virtual_camera.empty()) {
    VideoOutput(command.live.virtual_camera).check();
  }
  auto source = open_live(command, left_behind);
  note_interrupts();
  LiveProgram program(command.live, std::move(source), say);
  const std::string url = page_url(command.live.web, program.port());
  std::cout << "Live page: " << url << " (press Ctrl-C to stop)" << std::endl;
  if (command.open) {
    try {
      open_page(url);
    } catch (const Error& e) {
      say(MessageLevel::warning, e.what());
    }
  }
  wait_for_end(command, program, say);
  const LiveReport report = program.report();
  print_report(report);
  if (report.failure) {
    fail(*report.failure);
  }
}

}  // namespace

void add_live_command(CLI::App& app, const LeftBehind& left_behind) {
  const auto options = std::make_shared<LiveCommand>();
  CLI::App* command =
      app.add_subcommand("live", "Track the webcam and drive an avatar on a page and in other programs");
  add_track_options(*command, options->track);
  command->get_option("INPUT")->required(false)->description(
      "Camera (its index, device or a part of its name), stream URL, file, or `demo`: the bundled clip. "
      "Without it: the first camera.");
  for (const char* name : {"--frames", "--offline"}) {
    command->remove_option(command->get_option(name));
  }
  command->get_option("--quiet")->description(
      "Print only the address of the page, warnings, errors and the statistics at the end.");
  LiveRequest& live = options->live;
#ifdef TELEMIME_MEETING
  live.sender_kinds = meeting::kAllSenderKinds;
#endif
  command->add_option("--calibration", options->track.request.calibration,
                      "File that `telemime calibrate` wrote.");
  auto* const guide =
      command->add_flag("--guide", options->guided,
                        "Ask the person to leave the image first, which improves the fit; the "
                        "default where the networks are not installed.");
  command->add_flag("--no-guide", options->unguided, "Start without asking the person to leave the image.")
      ->excludes(guide);
  command->add_flag("--open", options->open, "Open the page in the default browser.");
  command->add_flag("--loop", options->loop, "Repeat a file from its start when it ends.");
  command
      ->add_option("--send", live.send,
                   "URL to send the motion to, for instance vmc://localhost:39539; may be repeated.")
      ->allow_extra_args(false);
  command->add_option("--virtual-camera", live.virtual_camera,
                      "Show the image with the tracked body as a camera for other programs: a device of "
                      "v4l2loopback, such as /dev/video9.");
  command->add_flag("--resume-outputs", live.resume_outputs,
                    "Send to the outputs that were added on the page in earlier runs.");
  command->add_flag("--no-settings", options->no_settings,
                    "Neither read nor write the settings of earlier runs.");
  command->add_option("--avatars", live.more_avatars, "Folder with more avatars for the pages: VRM files.");
  command->add_option("--port", live.web.port, "Port of the page [7070].");
  command->add_option("--address", live.web.address,
                      "Address at which the page is served [127.0.0.1: this computer only].");
  command
      ->add_option("--allow-host", live.web.hosts,
                   "Another host name under which the page can be opened; may be repeated.")
      ->allow_extra_args(false);
  command->add_option("--recordings", live.recordings, "Folder of the recordings [telemime-recordings].");
  command->add_flag("--no-fingers{false}", options->track.request.output_options.fingers,
                    "Recordings without fingers; pose.jsonl and pose.csv keep them.");
  command->add_option("--seconds", options->seconds, "Stop after this number of seconds [0: never].");
  command->callback([options, left_behind] { run(*options, left_behind); });
}

}  // namespace telemime
