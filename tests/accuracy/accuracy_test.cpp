// SPDX-License-Identifier: Apache-2.0
// The accuracy gate: clips with exact truth, tracked as a user tracks them, must stay within stated errors.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iostream>
#include <iterator>
#include <string>
#include <utility>

#include "telemime/core/scratch_folder.h"
#include "telemime/evaluation/evaluate.h"
#include "telemime/outputs/readers/jsonl.h"

namespace telemime {
namespace {

namespace fs = std::filesystem;

// Errors of elbows and wrists, mean over the frames.
struct Bounds {
  double millimetres;  // mid-shoulders aligned
  double pixels;       // of the clip, which is 320x240
};

const fs::path kDemo = fs::path(TELEMIME_SOURCE_DIR) / "data/demo";
constexpr Bounds kDemoBounds = {40.0, 2.0};

std::string text_of(const fs::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

// Runs a command line and fails the test with its output when it fails.
void run(const std::string& command, const fs::path& folder) {
  const std::string log = (folder / "log").string();
  ASSERT_EQ(std::system((command + " > '" + log + "' 2>&1").c_str()), 0) << command << '\n' << text_of(log);
}

// `telemime track` with default settings and seed 1; the poses are written to folder/out.
void track(const fs::path& clip, const std::string& ending, const fs::path& folder) {
  run("'" TELEMIME_PROGRAM "' track '" + (clip / ("video" + ending)).string() + "' --background '" +
          (clip / ("background" + ending)).string() + "' --seed 1 --no-overlay --out '" +
          (folder / "out").string() + "'",
      folder);
}

// The frames in which the estimated arms are nearer to the true arms of the other side: the distances of
// elbows and wrists, summed, fall when left and right of the estimate are exchanged. The shoulders' middle is
// aligned.
int exchanged_frames(const PoseFile& poses, const Truth& truth) {
  int count = 0;
  for (const MotionFrame& frame : poses.frames) {
    const auto t = static_cast<std::size_t>(frame.frame);
    const auto estimate = shoulder_centred(as_truth(frame.joints));
    const auto goal = t < truth.frames.size() ? shoulder_centred(truth.frames[t]) : std::nullopt;
    if (!estimate || !goal) {
      continue;
    }
    const auto distance = [&](Joint a, Joint b) {
      return (*(*estimate)[static_cast<std::size_t>(a)] - *(*goal)[static_cast<std::size_t>(b)]).norm();
    };
    double own = 0.0;
    double other = 0.0;
    for (const auto& [l, r] :
         {std::pair(Joint::l_elbow, Joint::r_elbow), std::pair(Joint::l_wrist, Joint::r_wrist)}) {
      own += distance(l, l) + distance(r, r);
      other += distance(l, r) + distance(r, l);
    }
    count += other < own ? 1 : 0;
  }
  return count;
}

// What is wrong with the poses in `folder`; empty when they are within the bounds.
std::string complaints(const fs::path& folder, const Truth& truth, const Bounds& bounds) {
  const PoseFile poses = read_pose_jsonl(folder / "out/pose.jsonl");
  const Evaluation e = evaluate(poses.frames, poses.camera, truth, {});
  const double millimetres = 1000.0 * e.tracked.scored.aligned.value_or(1e9);
  const double pixels = e.tracked.scored.pixels.value_or(1e9);
  const int exchanged = exchanged_frames(poses, truth);
  std::cout << "3-D " << millimetres << " mm, 2-D " << pixels << " px\n";
  std::string text;
  const auto complain = [&](bool wrong, const std::string& what) { text += wrong ? what + "; " : ""; };
  complain(millimetres > bounds.millimetres,
           std::to_string(millimetres) + " mm, at most " + std::to_string(bounds.millimetres));
  complain(pixels > bounds.pixels, std::to_string(pixels) + " px, at most " + std::to_string(bounds.pixels));
  complain(e.lost > 0.0, "lost in " + std::to_string(100.0 * e.lost) + " % of the frames");
  complain(!e.swapped.empty() || exchanged > 0,
           "left and right exchanged in " + std::to_string(exchanged) + " frames");
  return text;
}

// The truth of the person's mirror image: every left joint is called right.
Truth exchanged_sides(Truth truth) {
  for (TruthJoints& joints : truth.frames) {
    for (const auto& [l, r] :
         {std::pair(Joint::l_shoulder, Joint::r_shoulder), std::pair(Joint::l_elbow, Joint::r_elbow),
          std::pair(Joint::l_wrist, Joint::r_wrist), std::pair(Joint::l_hand, Joint::r_hand)}) {
      std::swap(joints[static_cast<std::size_t>(l)], joints[static_cast<std::size_t>(r)]);
    }
  }
  return truth;
}

TEST(Gate, DemoClip) {
  const ScratchFolder folder;
  track(kDemo, ".mp4", folder.path());
  const Truth truth = read_truth(kDemo / "truth.json");
  EXPECT_EQ(complaints(folder.path(), truth, kDemoBounds), "");
  // The gate itself: the same poses are refused where left and right are exchanged.
  const std::string refused = complaints(folder.path(), exchanged_sides(truth), kDemoBounds);
  EXPECT_NE(refused.find("exchanged in 165 frames"), std::string::npos) << refused;
  EXPECT_NE(refused.find(" mm, at most 40"), std::string::npos) << refused;
}

struct SynthClip {
  const char* gesture;
  int seed;
  Bounds bounds;  // a tenth to a fifth above the largest that several versions had
};

void PrintTo(const SynthClip& clip, std::ostream* out) {
  *out << clip.gesture << " with seed " << clip.seed;
}

class GestureGate : public testing::TestWithParam<SynthClip> {};

TEST_P(GestureGate, SyntheticClip) {
  const SynthClip& clip = GetParam();
  const ScratchFolder folder;
  run("'" TELEMIME_LAB_PROGRAM "' synth " + std::string(clip.gesture) + " --seed " +
          std::to_string(clip.seed) +
          " --size 320x240 --frames 80 --background-frames 20 --no-small --quiet --out '" +
          folder.path().string() + "'",
      folder.path());
  const fs::path files = folder.path() / clip.gesture;
  track(files, ".mkv", folder.path());
  EXPECT_EQ(complaints(folder.path(), read_truth(files / "truth.json"), clip.bounds), "");
}

INSTANTIATE_TEST_SUITE_P(Synth, GestureGate,
                         testing::Values(SynthClip{"raising_arms", 22, {57.0, 1.95}},
                                         SynthClip{"joy", 21, {37.0, 2.3}},
                                         SynthClip{"exclaiming", 23, {25.5, 2.42}}),
                         [](const auto& clip) { return std::string(clip.param.gesture); });

}  // namespace
}  // namespace telemime
