// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/experiments.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <system_error>

#include "telemime/core/files.h"

namespace telemime {
namespace {

constexpr std::string_view kPublished =
#include "published.inc"
    ;

std::string file_name(const std::string& title) {
  std::string name;
  for (const char c : title) {
    const auto u = static_cast<unsigned char>(c);
    if (std::isalnum(u) != 0) {
      name += static_cast<char>(std::tolower(u));
    } else if (!name.empty() && name.back() != '_') {
      name += '_';
    }
  }
  return name.substr(0, name.find_last_not_of('_') + 1) + ".csv";
}

constexpr std::array<Experiment, 35> kExperiments = {{
    {"F2-22", "Size of the first simplex",
     "Which factor of the typical change between frames leaves the smallest residual F?", simplex_size},
    {"T3-1", "Time of the background subtractions",
     "How long does each background subtraction take at 160x120?", background_times},
    {"F3-6", "Background subtractions when the light changes",
     "Which subtraction keeps the silhouette when a lamp comes on?", background_in_light},
    {"F3-13", "Regions: 500 iterations against convergence",
     "What does it cost F to stop the region step at 500 evaluations?", limited_regions},
    {"F3-14", "Edges: 500 iterations against convergence",
     "What does it cost D_C to stop the edge step at 500 evaluations?", limited_edges},
    {"T3-2", "Time of a frame by iterations",
     "How long does a frame at 160x120 take with so many evaluations, half on regions and half on edges?",
     frame_times},
    {"T3-3", "Time by image size", "What do features, one F and one D_C cost at each working size?",
     size_times},
    {"F3-16", "Mean F over the iterations", "How does mean F fall with region and edge evaluations?",
     region_residuals},
    {"F3-17", "Mean D_C over the iterations", "How does mean D_C fall with region and edge evaluations?",
     contour_residuals},
    {"F3-18", "Mistracked frames by F", "How many frames have a peak of F?", region_mistrackings},
    {"F3-19", "Mistracked frames by D_C", "How many frames have a peak of D_C?", contour_mistrackings},
    {"F3-24", "3-D error of each step run to convergence",
     "Which step alone is nearer to the true joints on joy?", steps_to_convergence},
    {"F3-25", "3-D error of 500 iterations, shared or not",
     "Is it better to share 500 evaluations between the steps?", steps_sharing},
    {"F3-26", "3-D error over the iterations", "Do more evaluations always lower the 3-D error?",
     surfaces_3d},
    {"F3-27", "2-D error over the iterations", "Do more evaluations lower the 2-D error?", surfaces_2d},
    {"F3-28", "Quadratic fit of the 2-D error", "How well does a quadratic describe the 2-D error?",
     quadratic},
    {"F3-29", "Best point for one time", "Where on the line of one budget is the 2-D error smallest?",
     tangent_point},
    {"F3-30", "Best split for every time", "From which budget on do edges earn a share?", best_curve},
    {"F4-11", "Weight-based resampling: 3-D error",
     "Does weight-based deterministic resampling lower the 3-D error of CONDENSATION?", wd_accuracy},
    {"F4-12", "Weight-based resampling: mistracked frames",
     "Does weight-based deterministic resampling lose the person less often?", wd_robustness},
    {"F4-13", "Motion-based partitions: 3-D error",
     "Does it lower the 3-D error to diffuse only what has moved?", hpm_accuracy},
    {"F4-14", "Motion-based partitions: mistracked frames",
     "Does it save mistracked frames to diffuse only what has moved?", hpm_robustness},
    {"F4-16", "Local optimisation: 3-D error",
     "What does local optimisation of large families do to the 3-D error?", lo_accuracy},
    {"F4-17", "Local optimisation: mistracked frames",
     "Does local optimisation of large families keep the person?", lo_robustness},
    {"F4-20", "Kinematic flipping: 3-D error", "Does flipping lower the 3-D error?", kf_accuracy},
    {"F4-21", "Kinematic flipping: mistracked frames", "Does flipping make tracking steadier?",
     kf_robustness},
    {"F4-25", "End-effector space: 3-D error", "Does end-effector space help with motion in depth?",
     ee_accuracy},
    {"F4-26", "End-effector space: mistracked frames", "Does end-effector space keep the person?",
     ee_robustness},
    {"F4-29", "All heuristics: 3-D error", "How near to the truth are all heuristics together?",
     all_accuracy},
    {"F4-30", "All heuristics: mistracked frames", "From how many particles on is no frame mistracked?",
     all_robustness},
    {"F4-33", "Real clips: mistracked frames", "Do all heuristics together lose real people less often?",
     real_clips},
    {"T4-1", "Time of overlap histograms", "How long do so many overlap histograms take?", overlap_times},
    {"ablation", "Each cue and heuristic left out", "What does each cue and heuristic contribute?", ablation},
    {"levers", "Each part of the program left out", "What is each part of the whole program good for?",
     levers},
    {"learned", "Each learned part left out",
     "What do networks, their cues and proposals add in a room as it is?", learned_parts},
}};

}  // namespace

std::span<const Experiment> experiments() {
  return kExperiments;
}

const Experiment* find_experiment(std::string_view id) {
  const auto* const found =
      std::find_if(kExperiments.begin(), kExperiments.end(), [&](const auto& e) { return e.id == id; });
  return found != kExperiments.end() ? found : nullptr;
}

std::string verdict(std::initializer_list<bool> statements, const std::string& text) {
  const auto held = std::count(statements.begin(), statements.end(), true);
  const std::string head = held == static_cast<std::ptrdiff_t>(statements.size()) ? "Agrees: "
                           : held > 0                                             ? "Partly agrees: "
                                                                                  : "Differs: ";
  return head + text;
}

Section run_experiment(const Experiment& experiment, Lab& lab) {
  lab.log(std::string(experiment.id) + " " + std::string(experiment.title));
  const std::string id(experiment.id);
  return {id, std::string(experiment.title), std::string(experiment.question), published_values(id),
          experiment.run(lab)};
}

std::vector<std::string> conditions(const LabOptions& options) {
  std::vector<std::string> lines = {
      "Published values are those of D. A. Gomez Jauregui, Telecom SudParis, 2011. An iteration is one "
      "evaluation of a cost (F or D_C), because evaluations take the time.",
      "Sequences: raising_arms, joy, exclaiming and asking from " + options.data.filename().string() +
          ", working image 160x120, seed " + std::to_string(options.seed) + ".",
      "The search of chapter 3 is the thesis's own: one downhill simplex over all 23 numbers, F then D_C, no "
      "prior, each frame from the pose of the previous one, unless a line says 'ours'. "
      "Features, joint limits (the anatomical set) and the calibration of body and first pose are ours in "
      "both.",
      "The particle filter of chapter 4 is the thesis's: the heaviest particle is the estimate, and it knows "
      "only the image, the joint limits and that the body is solid. data/filter.json holds what was learned "
      "from sequences. Every filter runs with several seeds.",
      "3-D errors are those of elbows and wrists with the mid-shoulders made to coincide; 2-D errors are "
      "those "
      "of the same joints in the image, in mm at the person's depth. The scale is that of an average head: "
      "no "
      "height is given.",
      "A frame is mistracked above F " + number(options.peaks.region) + " or D_C " +
          number(options.peaks.contour) + " px.",
      "The thesis's robustness figures of chapter 3 are from six films of real people, ours from the four "
      "gestures: the shapes of curves can be compared, their heights cannot.",
      "Times are processor time of one thread, median of several repeats."};
  if (options.quick) {
    lines.emplace_back(
        "QUICK RUN: 24 frames of each sequence and coarse grids. It shows that everything works; the numbers "
        "mean little.");
  }
  return lines;
}

Table published_values(const std::string& id) {
  static const auto kTables = nlohmann::json::parse(kPublished);
  if (!kTables.contains(id)) {
    return {"published", {"quantity"}, {}};
  }
  const auto lines = kTables[id].get<std::vector<std::vector<std::string>>>();
  return {"published", lines.front(), {lines.begin() + 1, lines.end()}};
}

void write_text(const std::filesystem::path& file, const std::string& text) {
  std::error_code failure;
  std::filesystem::create_directories(file.parent_path(), failure);
  write_whole_file(file, text);
}

void write_section(const std::filesystem::path& folder, const Section& section) {
  const std::filesystem::path own = folder / section.id;
  nlohmann::ordered_json json = {{"id", section.id},
                                 {"title", section.title},
                                 {"question", section.question},
                                 {"published", to_csv(section.published)},
                                 {"notes", section.finding.notes},
                                 {"verdict", section.finding.verdict},
                                 {"tables", nlohmann::ordered_json::array()}};
  for (const Table& table : section.finding.tables) {
    write_text(own / file_name(table.title), to_csv(table));
    json["tables"].push_back({{"title", table.title}, {"file", file_name(table.title)}});
  }
  if (!section.finding.picture.empty()) {
    std::vector<unsigned char> png;
    cv::imencode(".png", section.finding.picture, png);
    write_text(own / "picture.png", {png.begin(), png.end()});
  }
  write_text(own / "section.json", json.dump(2) + "\n");
}

}  // namespace telemime
