// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/all.h"

#include <algorithm>

namespace telemime {

std::string verdict(std::initializer_list<bool> statements, const std::string& words) {
  const auto held = std::count(statements.begin(), statements.end(), true);
  const std::string head = held == static_cast<std::ptrdiff_t>(statements.size()) ? "Agrees: "
                           : held > 0                                             ? "Partly agrees: "
                                                                                  : "Differs: ";
  return head + words;
}

Section run_experiment(const Experiment& experiment, Lab& lab) {
  lab.say(std::string(experiment.id) + " " + std::string(experiment.title));
  Section section;
  section.id = experiment.id;
  section.title = experiment.title;
  section.question = experiment.question;
  section.published = published_values(section.id);
  section.finding = experiment.run(lab);
  return section;
}

std::vector<std::string> conditions(const LabOptions& options) {
  std::vector<std::string> lines;
  lines.push_back("Sequences: raising_arms, joy, exclaiming, asking from " +
                  options.data.filename().string() + ", working image 160x120, seed " +
                  std::to_string(options.seed) + ".");
  lines.emplace_back(
      "The search of chapter 3 is the thesis's own (one downhill simplex over all 23 numbers, F then D_C, no "
      "prior, each "
      "frame from the pose of the one before), unless a line says 'ours'. Features, joint limits (the "
      "anatomical set), calibration of build and first pose are ours in both.");
  lines.emplace_back(
      "The particle filter of chapter 4 is the thesis's: the heaviest particle is the estimate, and nothing "
      "is "
      "known but the image, the joint limits and that the body is solid. What it knows from sequences is in "
      "data/filter.json. Every filter runs with several seeds.");
  lines.emplace_back(
      "3-D errors are of elbows and wrists with the mid-shoulders made to coincide; 2-D errors are of the "
      "same "
      "joints in the image, in mm at the person's depth. The scale is that of an average head: no height is "
      "given.");
  lines.push_back("A frame is mistracked above F " + number(options.peaks.region) + " or D_C " +
                  number(options.peaks.contour) + " px.");
  lines.emplace_back(
      "The thesis's robustness figures of chapter 3 are of six films of real people, ours of the four "
      "gestures: shapes of curves can be compared, heights cannot.");
  lines.emplace_back("Times are computing time of one thread, median of several repeats.");
  if (options.quick) {
    lines.emplace_back(
        "QUICK RUN: 24 frames of each sequence, coarse grids. It shows that everything works; the numbers "
        "mean "
        "little.");
  }
  return lines;
}

}  // namespace telemime
