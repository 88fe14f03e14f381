// SPDX-License-Identifier: Apache-2.0
#include "synth_command.h"

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <chrono>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "cli/progress_bar.h"
#include "lab/synth/sequence.h"
#include "telemime/core/errors.h"

namespace telemime {
namespace {

struct SynthArguments {
  std::string gesture;
  std::string size = "640x480";
  bool quiet = false;
  SequenceOptions sequence;
};

void read_size(const std::string& words, SceneOptions& scene) {
  std::size_t used = 0;
  try {
    scene.width = std::stoi(words, &used);
    if (used < words.size() && words[used] == 'x') {
      const std::string rest = words.substr(used + 1);
      scene.height = std::stoi(rest, &used);
      if (used == rest.size()) {
        return;
      }
    }
  } catch (const std::exception&) {
    used = 0;  // no number, or too long a one: the same words as for any other mistake, below
  }
  throw Error(ErrorKind::usage, "--size \"" + words + "\" is not a size in pixels",
              "write it as width x height, for instance 640x480");
}

void run_synth(const SynthArguments& arguments) {
  SequenceOptions options = arguments.sequence;
  read_size(arguments.size, options.scene);
  const std::vector<std::string> gestures =
      arguments.gesture == "all" ? std::vector<std::string>(kGestureNames.begin(), kGestureNames.end())
                                 : std::vector<std::string>{arguments.gesture};
  for (const std::string& gesture : gestures) {
    options.scene.gesture = gesture_named(gesture);
    ProgressBar bar(arguments.quiet);
    const auto start = std::chrono::steady_clock::now();
    const auto seconds = [&] {
      return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    };
    options.progress = [&](int done, int all) { bar.show(done, all, seconds()); };
    const SequenceFiles files = make_sequence(options);
    bar.interrupt();
    if (!arguments.quiet) {
      std::cerr << gesture << ": " << files.video.string() << " and " << files.all.size() - 1
                << " more files, in " << seconds() << " s\n";
    }
  }
}

}  // namespace

void add_synth_command(CLI::App& app) {
  const auto arguments = std::make_shared<SynthArguments>();
  SequenceOptions& sequence = arguments->sequence;
  SceneOptions& scene = sequence.scene;
  CLI::App* const command =
      app.add_subcommand("synth", "Make clips of an animated person with the exact joint positions");
  command
      ->add_option("GESTURE", arguments->gesture,
                   "raising_arms, joy, exclaiming, asking, or all of them: all")
      ->required();
  command->add_option("--out", sequence.folder, "the files go to a folder in here, named like the gesture")
      ->required();
  command->add_option("--size", arguments->size, "of the image, pixels")->capture_default_str();
  command->add_option("--seed", scene.seed, "another person, room and manner for each number")
      ->capture_default_str();
  command
      ->add_option("--frames", scene.frames,
                   "of the clip, 25 a second; the gesture takes 165 and starts again")
      ->capture_default_str();
  command
      ->add_option("--background-frames", sequence.background_frames,
                   "of the clip without the person, 0: none")
      ->capture_default_str();
  command->add_option("--noise", scene.sensor.noise, "of the camera, standard deviation in grey levels")
      ->capture_default_str();
  command->add_flag("--light-change", scene.light_change, "a lamp comes on in the middle of the clip");
  command->add_flag("--long-sleeves", scene.long_sleeves, "a shirt with sleeves to the wrist");
  command->add_flag("--striped", scene.striped_shirt, "a striped shirt");
  command->add_flag("--no-small{false}", sequence.small_videos, "without the lossless 160-pixel copies");
  command->add_flag("--mp4", sequence.compact,
                    "write small H.264 clips (.mp4) instead of lossless ones (.mkv)");
  command->add_option("--threads", sequence.threads, "0: all cores; the pixels do not depend on it")
      ->capture_default_str();
  command->add_flag("--quiet", arguments->quiet, "no progress and no summary");
  command->callback([arguments] { run_synth(*arguments); });
}

}  // namespace telemime
