// SPDX-License-Identifier: Apache-2.0
// What somebody who watches a run asks for, at any moment: no frame that was tracked is lost.
#include <gtest/gtest.h>

#include "telemime/core/scratch_folder.h"
#include "telemime/offline/track_file.h"
#include "telemime/outputs/readers/jsonl.h"
#include "track/quick_run.h"

namespace telemime {
namespace {

constexpr int kLookAhead = 12;  // 1/25 s, frames of this clip

TrackRequest short_run(const ScratchFolder& folder) {
  TrackRequest request;
  request.input = TELEMIME_SOURCE_DIR "/data/demo/video.mp4";
  request.background = TELEMIME_SOURCE_DIR "/data/demo/background.mp4";
  request.out = folder.path();
  request.formats = {"jsonl"};
  request.overlay = false;
  request.most_frames = 30;
  request.config = quick_config();
  request.config.calibration.look_ahead = kLookAhead;
  return request;
}

// The frames that are written.
std::vector<std::int64_t> frames_in(const ScratchFolder& folder) {
  std::vector<std::int64_t> frames;
  for (const MotionFrame& frame : read_pose_jsonl(folder.path() / "pose.jsonl").frames) {
    frames.push_back(frame.frame);
  }
  return frames;
}

std::vector<std::int64_t> first(std::int64_t count) {
  std::vector<std::int64_t> frames;
  for (std::int64_t i = 0; i < count; ++i) {
    frames.push_back(i);
  }
  return frames;
}

TEST(ViewerRequests, CalibratingAgainTakesTheNewBones) {
  const ScratchFolder folder;
  int written = 0;
  RunHooks hooks;
  hooks.progress = [&](const Progress& progress) {
    written += progress.motion != nullptr ? 1 : 0;
    return progress.motion != nullptr && written == 10 ? ViewerRequest::recalibrate : ViewerRequest::none;
  };
  std::vector<double> forearms;
  hooks.motion = [&](const MotionFrame& motion) {
    forearms.push_back((motion.joints[Joint::l_wrist] - motion.joints[Joint::l_elbow]).norm());
  };
  const TrackSummary summary = track_file(short_run(folder), hooks);
  EXPECT_FALSE(summary.interrupted);
  EXPECT_EQ(frames_in(folder), first(30));
  ASSERT_EQ(forearms.size(), 30U);
  EXPECT_NEAR(forearms[5], forearms[0], 1e-9);
  EXPECT_GT(std::abs(forearms[29] - forearms[0]), 1e-6) << "fitted to other frames";
}

TEST(ViewerRequests, EveryPictureIsShown) {
  const ScratchFolder folder;
  int pictures = 0;
  RunHooks hooks;
  hooks.picture = [&](const cv::Mat& picture) { pictures += picture.empty() ? 0 : 1; };
  track_file(short_run(folder), hooks);
  EXPECT_EQ(pictures, 30);
}

// An empty room: its frames pass while the body waits to be fitted.
TEST(ViewerRequests, StoppedBeforeAnybodyIsSeenItStops) {
  const ScratchFolder folder;
  TrackRequest request = short_run(folder);
  request.input = request.background;
  RunHooks hooks;
  hooks.progress = [](const Progress& progress) {
    return progress.motion != nullptr && progress.frames == 3 ? ViewerRequest::stop : ViewerRequest::none;
  };
  const TrackSummary summary = track_file(request, hooks);
  EXPECT_TRUE(summary.interrupted);
  EXPECT_LE(frames_in(folder).size(), 4U) << "the next one may be under way";
}

TEST(ViewerRequests, StoppedWhileTheBodyIsFittedItKeepsWhatItHas) {
  const ScratchFolder folder;
  int fitted = 0;
  RunHooks hooks;
  hooks.progress = [&](const Progress& progress) {
    fitted += progress.motion == nullptr ? 1 : 0;
    return progress.motion == nullptr && fitted == 5 ? ViewerRequest::stop : ViewerRequest::none;
  };
  const TrackSummary summary = track_file(short_run(folder), hooks);
  EXPECT_TRUE(summary.interrupted);
  EXPECT_EQ(frames_in(folder), first(5));
}

}  // namespace
}  // namespace telemime
