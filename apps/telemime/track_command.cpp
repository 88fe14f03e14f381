// SPDX-License-Identifier: Apache-2.0
#include "commands.h"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <iostream>
#include <memory>
#include <opencv2/highgui.hpp>

#include "cli/exit_codes.h"
#include "cli/progress_bar.h"
#include "telemime/capture/input_kind.h"
#include "telemime/core/errors.h"
#include "telemime/offline/track_file.h"
#include "track_options.h"

namespace telemime {
namespace {

volatile std::sig_atomic_t interrupt_requested = 0;

void on_interrupt(int) {
  interrupt_requested = 1;
}

// Whether a window can be opened, tried in a process of its own: where there is no display some toolkits
// abort.
bool window_opens() {
  const pid_t child = ::fork();
  if (child == 0) {
    const rlimit no_core{0, 0};
    ::setrlimit(RLIMIT_CORE, &no_core);
    if (std::freopen("/dev/null", "w", stderr) == nullptr) {
      ::_exit(1);
    }
    try {
      cv::namedWindow("telemime");
      cv::waitKey(1);
      ::_exit(0);
    } catch (const cv::Exception&) {
      ::_exit(1);
    }
  }
  int status = -1;
  return child > 0 && ::waitpid(child, &status, 0) == child && status == 0;
}

ViewerRequest show_window(const Progress& progress) {
  constexpr const char* kTitle = "telemime   space: pause   r: recalibrate   q: quit";
  if (progress.overlay != nullptr) {
    cv::imshow(kTitle, *progress.overlay);
  }
  int key = cv::waitKey(1);
  if (key == ' ') {
    do {
      key = cv::waitKey(50);
    } while (key != ' ' && key != 'q' && key != 27 && interrupt_requested == 0);
  }
  if (key == 'q' || key == 27) {
    return ViewerRequest::stop;
  }
  return key == 'r' ? ViewerRequest::recalibrate : ViewerRequest::none;
}

void print_summary(const TrackSummary& summary, const TrackRequest& request) {
  std::cout << summary.frames << " frames, " << summary.tracked << " tracked, in " << summary.seconds
            << " s (" << static_cast<double>(summary.frames) / std::max(1e-9, summary.seconds)
            << " frames per second)\n";
  if (summary.tracked > 0) {
    std::cout << "mean F " << summary.report["mean_F"].get<double>() << ", mean D_C "
              << summary.report["mean_D_C"].get<double>() << " px\n";
  }
  std::cout << "results in " << request.out.string() << '\n';
}

void run(const TrackOptions& options) {
  TrackRequest request = make_request(options);
  ProgressBar bar(options.quiet);
  RunHooks hooks;
  const bool show = options.show && window_opens();
  hooks.draw = show;
  if (options.show && !show) {
    std::cerr << "no window can be opened here (is there a display?); tracking goes on without it\n";
  }
  hooks.message = [&](const std::string& words) {
    if (!options.quiet) {
      bar.interrupt();
      std::cerr << words << '\n';
    }
  };
  hooks.progress = [&](const Progress& progress) {
    if (progress.motion == nullptr) {
      return interrupt_requested != 0 ? ViewerRequest::stop : ViewerRequest::none;
    }
    bar.show(progress.frames, progress.total, progress.seconds);
    const ViewerRequest wish = show ? show_window(progress) : ViewerRequest::none;
    return interrupt_requested != 0 ? ViewerRequest::stop : wish;
  };
  std::signal(SIGINT, on_interrupt);
  std::signal(SIGTERM, on_interrupt);
  const TrackSummary summary = track_file(request, hooks);
  bar.interrupt();
  if (!options.quiet) {
    print_summary(summary, request);
  }
  if (interrupt_requested != 0) {
    throw Interrupted();
  }
  if (summary.tracked == 0) {
    const auto& notes = summary.report["notes"];
    throw Error(ErrorKind::tracking, "nobody was tracked in " + shown_url(request.input),
                notes.empty() ? "Is there a person who faces the camera?"
                              : "The last reason: " + notes.back()["note"].get<std::string>());
  }
}

}  // namespace

void add_track_command(CLI::App& app) {
  const auto options = std::make_shared<TrackOptions>();
  CLI::App* command = app.add_subcommand("track", "Track the upper body of a person in a video, in 3-D");
  add_track_options(*command, *options);
  command->add_option("--out", options->request.out, "Folder of the results.")->default_val("telemime-out");
  command->add_option("--calibration", options->request.calibration, "File that `telemime calibrate` wrote.");
  command
      ->add_option("--formats", options->request.formats,
                   "Formats to write, of jsonl, csv, bvh, bap, glb, vrma and trc; by default all.")
      ->delimiter(',');
  command->add_option("--bap-profile", options->request.output_options.bap_profile,
                      "Signs and units of motion.bap: iso, greta, vreng-3.1 or vreng-3.2.");
  command->add_flag("--no-fingers{false}", options->request.output_options.fingers,
                    "Skeletons and markers without fingers; pose.jsonl and pose.csv keep them.");
  command->add_flag("--no-overlay{false}", options->request.overlay, "Write no overlay video.");
  command->add_flag("--show", options->show, "Show overlay, top view and residuals in a window.");
  command->callback([options] { run(*options); });
}

}  // namespace telemime
