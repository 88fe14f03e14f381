// SPDX-License-Identifier: Apache-2.0
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <chrono>
#include <iostream>
#include <memory>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "cli/progress_bar.h"
#include "commands.h"
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

void read_size(const std::string& text, SceneOptions& scene) {
  std::istringstream in(text);
  char by = '\0';
  if (!(in >> scene.width >> by >> scene.height) || by != 'x' || in.peek() != EOF) {
    throw Error(ErrorKind::usage, "--size \"" + text + "\" is not a size in pixels",
                "write it as width x height, for instance 640x480");
  }
}

void run_synth(const SynthArguments& arguments) {
  SequenceOptions options = arguments.sequence;
  read_size(arguments.size, options.scene);
  const std::vector<std::string> gestures =
      arguments.gesture == "all" ? std::vector<std::string>(kThesisGestures.begin(), kThesisGestures.end())
                                 : std::vector<std::string>{arguments.gesture};
  for (const std::string& gesture : gestures) {
    options.scene.gesture = gesture_named(gesture);
    ProgressBar bar(arguments.quiet);
    const auto start = std::chrono::steady_clock::now();
    const auto seconds = [&] {
      return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    };
    options.progress = [&](int done, int all) { bar.show("", done, all, seconds()); };
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
                   "raising_arms, joy, exclaiming, asking, talking; all: the first four")
      ->required();
  command->add_option("--out", sequence.folder, "the files go to DIR/GESTURE")->required();
  command->add_option("--size", arguments->size, "image size, pixels")->capture_default_str();
  command
      ->add_option("--seed", scene.seed, "each number gives another person, background and manner of moving")
      ->capture_default_str();
  command
      ->add_option("--frames", scene.frames,
                   "length of the clip, 25 a second; a gesture takes 165 and repeats")
      ->capture_default_str();
  command
      ->add_option("--background-frames", sequence.background_frames,
                   "length of the clip without the person; 0: none")
      ->capture_default_str();
  command->add_option("--noise", scene.sensor.noise, "camera noise, standard deviation in grey levels")
      ->capture_default_str();
  command->add_flag("--light-change", scene.light_change, "a lamp comes on in the middle of the clip");
  command->add_flag("--long-sleeves", scene.long_sleeves, "a shirt with sleeves to the wrist");
  command->add_flag("--striped", scene.striped_shirt, "a striped shirt");
  command
      ->add_option("--distance", scene.distance, "of the person, m; 0: as the gesture is staged, about 1.4")
      ->capture_default_str();
  constexpr double kDegree = std::numbers::pi / 180.0;
  command->add_option_function<double>(
      "--camera-pitch", [&scene](double degrees) { scene.camera_pitch = degrees * kDegree; },
      "degrees by which the camera looks up, as that of a laptop does; negative: down");
  command->add_option_function<double>(
      "--turn", [&scene](double degrees) { scene.turn = degrees * kDegree; },
      "degrees by which the person sits turned to their left, the face to the camera; negative: to their "
      "right");
  command->add_flag_callback(
      "--look-around", [&scene] { scene.look_around = std::numbers::pi / 3.0; },
      "the head turns by 60 degrees to either side and nods; truth.json has its rotation, as that of every "
      "clip");
  command->add_flag("--fingers", scene.fingers, "the fingers move; truth.json has their joints");
  command->add_option("--people", scene.people,
                      "people of meshes instead of drawn ones; the folder that apps/lab/people.sh prints");
  command->add_flag("--walk-in", scene.walk_in,
                    "the person walks in and out of an empty scene (120 frames or more)");
  command->add_flag("--no-small{false}", sequence.small_videos, "without the lossless 160-pixel copies");
  command->add_flag("--mp4", sequence.compact,
                    "write small H.264 clips (.mp4) instead of lossless ones (.mkv)");
  command->add_option("--threads", sequence.threads, "0: all cores; the pixels do not depend on it")
      ->capture_default_str();
  command->add_flag("--quiet", arguments->quiet, "no progress and no summary");
  command->callback([arguments] { run_synth(*arguments); });
}

}  // namespace telemime
