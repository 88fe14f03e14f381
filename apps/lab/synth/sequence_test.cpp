// SPDX-License-Identifier: Apache-2.0
#include "lab/synth/sequence.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <set>

#include "telemime/capture/source.h"
#include "telemime/core/scratch_folder.h"
#include "telemime/core/testing_errors.h"

namespace telemime {
namespace {

SceneOptions small_scene(Gesture gesture) {
  SceneOptions options;
  options.gesture = gesture;
  options.width = 80;
  options.height = 60;
  return options;
}

SequenceOptions compact_clip(const std::filesystem::path& folder, int background_frames) {
  SequenceOptions options;
  options.scene = small_scene(Gesture::asking);
  options.scene.frames = 2;
  options.background_frames = background_frames;
  options.folder = folder;
  options.compact = true;
  return options;
}

bool same(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() && cv::norm(a, b, cv::NORM_INF) == 0.0;
}

class SequenceFolder : public testing::Test {
 protected:
  ScratchFolder scratch;
  std::filesystem::path folder = scratch.path() / "made";
};

TEST_F(SequenceFolder, WritesLosslessClipsAndTruth) {
  SequenceOptions options;
  options.scene = small_scene(Gesture::joy);
  options.scene.width = 192;
  options.scene.height = 144;
  options.scene.frames = 3;
  options.background_frames = 2;
  options.folder = folder;
  options.threads = 2;
  int calls = 0;
  options.progress = [&](int done, int all) {
    EXPECT_EQ(done, ++calls);
    EXPECT_EQ(all, 5);
  };
  const SequenceFiles files = make_sequence(options);
  EXPECT_EQ(calls, 5);
  for (const char* name : {"video.mkv", "video_160x120.mkv", "background.mkv", "background_160x120.mkv",
                           "truth.json", "preview.png"}) {
    EXPECT_TRUE(std::filesystem::exists(folder / "joy" / name)) << name;
  }
  EXPECT_EQ(files.all.size(), 6u);
  EXPECT_EQ(files.video, folder / "joy" / "video.mkv");

  const Scene scene = make_scene(options.scene);
  const auto source = open_source(files.video.string());
  for (int frame = 0; frame < 3; ++frame) {
    const auto read = source->next();
    ASSERT_TRUE(read.has_value());
    EXPECT_TRUE(same(read->image, render_frame(scene, frame).image)) << "frame " << frame;
  }
  EXPECT_FALSE(source->next().has_value());

  const auto truth = nlohmann::json::parse(std::ifstream(folder / "joy" / "truth.json"));
  EXPECT_EQ(truth["frames"], 3);
  EXPECT_EQ(truth["joints"].size(), kJointCount);
  EXPECT_EQ(truth["joints"][7], "l_wrist");
  EXPECT_EQ(truth["positions"].size(), 3u);
  const double x = truth["positions"][1][7][0];
  EXPECT_NEAR(x, 1000.0 * scene_kinematics(scene, 1).joints[Joint::l_wrist].x(), 0.006);
  EXPECT_NEAR(truth["bone_lengths"]["l_elbow-l_wrist"].get<double>(), 1000.0 * scene.look.build.forearm,
              0.006);
}

TEST_F(SequenceFolder, ACompactClipIsMp4) {
  const SequenceOptions options = compact_clip(folder, 0);
  const SequenceFiles files = make_sequence(options);
  EXPECT_EQ(files.video, folder / "asking" / "video.mp4");
  const auto source = open_source(files.video.string());
  EXPECT_TRUE(source->next().has_value());
  EXPECT_FALSE(std::filesystem::exists(folder / "asking" / "video_160x120.mkv"));
}

TEST_F(SequenceFolder, ClipsOfAnEarlierRunAreRemoved) {
  SequenceOptions options = compact_clip(folder, 1);
  make_sequence(options);
  std::ofstream(folder / "asking" / "notes.txt") << "mine";
  options.compact = false;
  options.background_frames = 0;
  const SequenceFiles files = make_sequence(options);
  std::set<std::filesystem::path> left;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "asking")) {
    left.insert(entry.path());
  }
  std::set<std::filesystem::path> expected(files.all.begin(), files.all.end());
  expected.insert(folder / "asking" / "notes.txt");
  EXPECT_EQ(left, expected);
}

TEST_F(SequenceFolder, AFolderThatCannotBeMadeIsNamed) {
  std::ofstream(folder.string()) << "in the way";
  SequenceOptions options;
  options.scene = small_scene(Gesture::asking);
  options.folder = folder;
  const std::string message = testing_errors::message_of(ErrorKind::output, [&] { make_sequence(options); });
  EXPECT_TRUE(testing_errors::names(message, "asking")) << message;
}

}  // namespace
}  // namespace telemime
