// SPDX-License-Identifier: Apache-2.0
#include "commands.h"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <iostream>
#include <memory>
#include <opencv2/highgui.hpp>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "cli/exit_codes.h"
#include "cli/interrupt.h"
#include "cli/progress_bar.h"
#include "telemime/capture/input_kind.h"
#include "telemime/core/errors.h"
#include "telemime/offline/track_file.h"
#include "track_many.h"
#include "track_options.h"

namespace telemime {
namespace {

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

struct ManyFiles {
  TrackOptions options;
  std::vector<std::string> inputs;
  int jobs = 1;
  bool again = false;
};

// A window that shows overlays. Tracking goes on without it when the user closes it.
class Viewer {
 public:
  void show(const cv::Mat& overlay) {
    if (state_ != State::closed) {
      cv::imshow(kTitle, overlay);
      state_ = State::open;
      poll();
    }
  }
  // What the user has asked for since the last call.
  ViewerRequest wish() {
    poll();
    return std::exchange(wish_, ViewerRequest::none);
  }

 private:
  enum class State { none, open, closed };
  static constexpr const char* kTitle = "telemime   space: pause   r: recalibrate   q: quit";

  // A closed window receives no keys. Some toolkits do not tell, which is -1.
  static bool is_open() { return cv::getWindowProperty(kTitle, cv::WND_PROP_VISIBLE) != 0.0; }

  void poll() {
    if (state_ != State::open) {
      return;
    }
    int key = cv::waitKey(1);
    if (key == ' ') {
      do {
        key = cv::waitKey(50);
      } while (key != ' ' && key != 'q' && key != 27 && is_open() && !interrupted());
    }
    state_ = is_open() ? State::open : State::closed;
    if (key == 'q' || key == 27) {
      wish_ = ViewerRequest::stop;
    } else if (key == 'r' && wish_ == ViewerRequest::none) {
      wish_ = ViewerRequest::recalibrate;
    }
  }

  State state_ = State::none;
  ViewerRequest wish_ = ViewerRequest::none;
};

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

// Tracks one file. Throws as track_file() does, Interrupted, and Error(tracking) when nobody was tracked.
TrackSummary track_one(const TrackRequest& request, const RunHooks& hooks) {
  const TrackSummary summary = track_file(request, hooks);
  if (interrupted()) {
    throw Interrupted();
  }
  if (summary.tracked == 0) {
    const auto& notes = summary.report["notes"];
    throw Error(ErrorKind::tracking, "nobody was tracked in " + shown_url(request.input),
                notes.empty() ? "Is there a person who faces the camera?"
                              : "The last reason: " + notes.back()["note"].get<std::string>());
  }
  return summary;
}

void run_one(const TrackOptions& options) {
  const TrackRequest request = make_request(options);
  ProgressBar bar(options.quiet);
  RunHooks hooks;
  const bool show = options.show && window_opens();
  Viewer viewer;
  if (show) {
    hooks.picture = [&viewer](const cv::Mat& overlay) { viewer.show(overlay); };
  }
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
    const bool ahead = progress.motion == nullptr;
    bar.show(ahead ? "fitting the body" : "", progress.frames, progress.total, progress.seconds);
    const ViewerRequest wish = viewer.wish();
    return interrupted() ? ViewerRequest::stop : wish;
  };
  note_interrupts();
  const TrackSummary summary = track_one(request, hooks);
  bar.interrupt();
  if (!options.quiet) {
    print_summary(summary, request);
  }
}

// Each file with the same options into a folder of its own. Where files run beside each other, each has its
// share of the processor.
int run_many(const ManyFiles& many) {
  if (many.options.show) {
    throw Error(ErrorKind::usage, "--show is for one file", "Omit it, or give one file.");
  }
  TrackRequest request = make_request(many.options);
  const int cores = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  if (request.config.threads == 0 && many.jobs > 1) {
    request.config.threads = std::max(1, cores / many.jobs);
  }
  const auto folders = folders_of(many.inputs, request.out);
  std::vector<TrackRequest> requests(many.inputs.size(), request);
  for (std::size_t i = 0; i < requests.size(); ++i) {
    requests[i].input = many.inputs[i];
    requests[i].out = folders[i];
  }
  return track_many(
      requests, {.jobs = many.jobs,
                 .again = many.again,
                 .quiet = many.options.quiet,
                 .track = [](const TrackRequest& each, const RunHooks& hooks) { track_one(each, hooks); }});
}

}  // namespace

void add_track_command(CLI::App& app) {
  const auto many = std::make_shared<ManyFiles>();
  TrackOptions* const options = &many->options;
  CLI::App* command = app.add_subcommand("track", "Track the upper body of a person in a video, in 3-D");
  add_track_options(*command, *options);
  command->remove_option(command->get_option("INPUT"));
  command
      ->add_option(
          "INPUT", many->inputs,
          "Video files, folders or patterns of images, or URLs of clips. With several, the results of "
          "each have a folder of their own in that of --out; those that are there are left as they are.")
      ->required();
  command->add_option("--jobs", many->jobs, "Number of files to track at the same time [1].")
      ->check(CLI::Range(1, 256));
  command->add_flag("--again", many->again, "Also track files that have results already.");
  command->add_option("--out", options->request.out, "Folder of the results.")
      ->default_val("telemime-out")
      ->check([](const std::string& folder) { return folder.empty() ? "a folder has a name" : ""; });
  command->add_option("--calibration", options->request.calibration, "File that `telemime calibrate` wrote.");
  command
      ->add_option("--formats", options->request.formats,
                   "Formats to write, of jsonl, csv, bvh, bap, glb, vrma and trc; by default all.")
      ->delimiter(',')
      ->allow_extra_args(false);
  command->add_option("--bap-profile", options->request.output_options.bap_profile,
                      "Signs and units of motion.bap: iso, greta, vreng-3.1 or vreng-3.2.");
  command->add_flag("--no-fingers{false}", options->request.output_options.fingers,
                    "Skeletons and markers without fingers; pose.jsonl and pose.csv keep them.");
  command->add_flag("--no-overlay{false}", options->request.overlay, "Write no overlay video.");
  command->add_flag("--show", options->show, "Show overlay, top view and residuals in a window.");
  command->callback([many, command] {
    // Either option says that there may be several, also where a pattern of the shell meets one.
    if (many->inputs.size() == 1 && command->count("--jobs") == 0 && command->count("--again") == 0) {
      many->options.request.input = many->inputs.front();
      run_one(many->options);
    } else if (const int code = run_many(*many); code != 0) {
      throw ToldAlready(code);
    }
  });
}

}  // namespace telemime
