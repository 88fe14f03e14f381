// SPDX-License-Identifier: Apache-2.0
// Track a clip with a cue of your own, and measure what the cue changes.
// Usage: 03_add_a_cue VIDEO BACKGROUND TRUTH    (for example the three files of data/demo)
#include <cstdio>
#include <filesystem>

#include "telemime/core/errors.h"
#include "telemime/evaluation/evaluate.h"
#include "telemime/offline/track_file.h"
#include "telemime/outputs/readers/jsonl.h"

namespace {

// Where the model's arms and the skin of arms and hands in the image do not overlap: 0 when they agree, 1
// when nothing overlaps. The built-in cue "regions" takes the mean over head, arms and clothes instead.
double arms_mismatch(const telemime::CueInput& input) {
  constexpr auto kArms = static_cast<std::size_t>(telemime::SurfaceClass::arms) - 1;
  const telemime::Reductions& r = input.reductions;
  const int either = r.observed[kArms] + r.model[kArms] - r.both[kArms];
  return either > 0 ? static_cast<double>(either - r.both[kArms]) / either : 0.0;
}

constexpr telemime::Cue kArmsCue = {
    .name = "arms",
    .what = "share of the arms' pixels in which image and model differ",
    .needs = telemime::Reduction::overlap,  // none for a cue of the joints alone: set needs_kinematics then
    .region_step = 0.3,
    .edge_step = 0.3,
    .sigma = 0.1,
    .cost = arms_mismatch,
};

// Mean 3-D error of elbows and wrists, mm.
double error_mm(const telemime::TrackRequest& request, const telemime::Truth& truth) {
  track_file(request, {});
  const telemime::PoseFile pose = telemime::read_pose_jsonl(request.out / "pose.jsonl");
  const telemime::Evaluation evaluation = evaluate(pose.frames, pose.camera, truth, {});
  return 1000.0 * evaluation.tracked.scored.aligned.value_or(0.0);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::puts("usage: 03_add_a_cue VIDEO BACKGROUND TRUTH");
    return 0;
  }
  try {
    const telemime::Truth truth = telemime::read_truth(argv[3]);
    telemime::TrackRequest request;
    request.input = argv[1];
    request.background = argv[2];
    request.out = std::filesystem::temp_directory_path() / "telemime_03_add_a_cue";
    request.formats = {"jsonl"};
    request.overlay = false;
    std::printf("without the cue: %.1f mm\n", error_mm(request, truth));
    add_cue(request.config, kArmsCue);
    std::printf("with the cue:    %.1f mm\n", error_mm(request, truth));
    std::filesystem::remove_all(request.out);
  } catch (const telemime::Error& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
  }
  return 0;
}
