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

// `telemime track` with default settings; the poses are written to folder/out.
void track(const fs::path& clip, const std::string& ending, int seed, const std::string& options,
           const fs::path& folder) {
  run("'" TELEMIME_PROGRAM "' track '" + (clip / ("video" + ending)).string() + "' --background '" +
          (clip / ("background" + ending)).string() + "' --seed " + std::to_string(seed) + options +
          " --no-overlay --out '" + (folder / "out").string() + "'",
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

std::string complaint(bool wrong, const std::string& what) {
  return wrong ? what + "; " : "";
}

// Which bounds the errors exceed; empty: none.
std::string excess(const Bounds& errors, const Bounds& bounds) {
  return complaint(
             errors.millimetres > bounds.millimetres,
             std::to_string(errors.millimetres) + " mm, at most " + std::to_string(bounds.millimetres)) +
         complaint(errors.pixels > bounds.pixels,
                   std::to_string(errors.pixels) + " px, at most " + std::to_string(bounds.pixels));
}

struct Tracked {
  Bounds errors;
  std::string complaints;  // of frames that are lost, or have left and right exchanged
};

// Of the poses in `folder`.
Tracked tracked_in(const fs::path& folder, const Truth& truth) {
  const PoseFile poses = read_pose_jsonl(folder / "out/pose.jsonl");
  const Evaluation e = evaluate(poses.frames, poses.camera, truth, {});
  const double millimetres = 1000.0 * e.tracked.scored.aligned.value_or(1e9);
  const double pixels = e.tracked.scored.pixels.value_or(1e9);
  const int exchanged = exchanged_frames(poses, truth);
  std::cout << "3-D " << millimetres << " mm, 2-D " << pixels << " px\n";
  return {{millimetres, pixels},
          complaint(e.lost > 0.0, "lost in " + std::to_string(100.0 * e.lost) + " % of the frames") +
              complaint(!e.swapped.empty() || exchanged > 0,
                        "left and right exchanged in " + std::to_string(exchanged) + " frames")};
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
  track(kDemo, ".mp4", 1, "", folder.path());
  const Truth truth = read_truth(kDemo / "truth.json");
  const Tracked tracked = tracked_in(folder.path(), truth);
  EXPECT_EQ(tracked.complaints, "");
  EXPECT_EQ(excess(tracked.errors, kDemoBounds), "");
  // The gate itself: the same poses are refused where left and right are exchanged.
  const Tracked refused = tracked_in(folder.path(), exchanged_sides(truth));
  EXPECT_NE(refused.complaints.find("exchanged in 165 frames"), std::string::npos) << refused.complaints;
  EXPECT_NE(excess(refused.errors, kDemoBounds).find(" mm, at most 40"), std::string::npos);
}

struct SynthClip {
  const char* gesture;
  int seed;
  Bounds bounds;  // of the mean of three runs: one run varies by 2 mm from seed to seed
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
  const Truth truth = read_truth(files / "truth.json");
  constexpr int kRuns = 3;
  Bounds mean{0.0, 0.0};
  for (int seed = 1; seed <= kRuns; ++seed) {
    // Hands and face change no pose of the body.
    // Several of these tests run at once; the poses are the same with any number of threads.
    track(files, ".mkv", seed, " --no-hands --no-face --threads 1", folder.path());
    const Tracked tracked = tracked_in(folder.path(), truth);
    EXPECT_EQ(tracked.complaints, "") << "seed " << seed;
    mean.millimetres += tracked.errors.millimetres / kRuns;
    mean.pixels += tracked.errors.pixels / kRuns;
  }
  EXPECT_EQ(excess(mean, clip.bounds), "");
}

INSTANTIATE_TEST_SUITE_P(Synth, GestureGate,
                         testing::Values(SynthClip{"raising_arms", 22, {57.0, 1.95}},
                                         SynthClip{"joy", 21, {37.0, 2.3}},
                                         SynthClip{"exclaiming", 23, {25.5, 2.42}}),
                         [](const auto& clip) { return std::string(clip.param.gesture); });

}  // namespace
}  // namespace telemime
