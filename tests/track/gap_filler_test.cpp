// SPDX-License-Identifier: Apache-2.0
#include "telemime/offline/gap_filler.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <utility>
#include <vector>

#include "telemime/core/scratch_folder.h"
#include "telemime/offline/run.h"
#include "track/quick_tracker.h"

namespace telemime {
namespace {

Config filling(int most) {
  Config config = quick_config();
  config.tracking.fill_back = most;
  return config;
}

// A tracker that knows the person, and what it saw and decided in each frame of the clip.
struct Tracked {
  explicit Tracked(const Config& config) : tracker(make_tracker(config)) {
    tracker.learn_background(clip().background);
    for (const Frame& frame : clip().person) {
      SeenFrame seen;
      tracker.look(frame, tracker.settled(), seen);
      PreparedFrame prepared = seen.prepared;
      TrackedFrame result = tracker.decide(seen);
      EXPECT_EQ(result.motion.state, TrackState::tracking) << frame.index;
      frames.push_back({{frame, "", result.motion, std::nullopt, {}}, std::move(prepared)});
    }
  }
  // As the tracker gives a frame in which it does not find the person whom it sees.
  GapFrame lost(std::size_t index) const {
    GapFrame frame = frames.at(index);
    frame.decided.motion.state = TrackState::lost;
    frame.decided.motion.pose = Pose{};
    frame.decided.motion.spread.reset();
    frame.decided.note = "not found";
    return frame;
  }
  GapFrame tracked(std::size_t index) const { return {frames.at(index).decided, std::nullopt}; }

  Tracker tracker;
  std::vector<GapFrame> frames;
};

std::vector<OfflineFrame> take(GapFiller& gaps) {
  std::vector<OfflineFrame> frames;
  while (auto frame = gaps.next()) {
    frames.push_back(std::move(*frame));
  }
  return frames;
}

TEST(GapFiller, WhoWasFoundIsFollowedBack) {
  const Tracked t(filling(10));
  GapFiller gaps(t.tracker);
  for (std::size_t i = 0; i + 1 < kPersonFrames; ++i) {
    EXPECT_EQ(gaps.push(t.lost(i)), 0U);
    EXPECT_TRUE(take(gaps).empty()) << i;
  }
  EXPECT_EQ(gaps.push(t.tracked(kPersonFrames - 1)), kPersonFrames - 1U);
  const auto frames = take(gaps);
  ASSERT_EQ(frames.size(), static_cast<std::size_t>(kPersonFrames));
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const MotionFrame& motion = frames[i].motion;
    EXPECT_EQ(motion.frame, static_cast<std::int64_t>(i));
    EXPECT_EQ(motion.state, TrackState::tracking) << i;
    EXPECT_EQ(frames[i].note, "") << i;
    EXPECT_TRUE(motion.spread) << i;
    for (const Joint joint : {Joint::l_elbow, Joint::r_elbow, Joint::l_wrist, Joint::r_wrist}) {
      const Eigen::Vector2d seen = clip().camera.project(clip().truth[i][joint]);
      EXPECT_LT((motion.pixels[static_cast<std::size_t>(joint)] - seen).norm(), 20.0)
          << "frame " << i << ", joint " << static_cast<int>(joint);
    }
  }
}

TEST(GapFiller, StopsWhereNobodyIsSeen) {
  const Tracked t(filling(10));
  GapFiller gaps(t.tracker);
  gaps.push(t.lost(0));
  GapFrame empty = t.lost(1);
  empty.seen.reset();
  gaps.push(empty);
  auto frames = take(gaps);
  ASSERT_EQ(frames.size(), 2U) << "nobody can be followed back to these";
  EXPECT_EQ(frames[0].motion.state, TrackState::lost);
  EXPECT_EQ(frames[0].note, "not found");
  EXPECT_EQ(frames[1].motion.state, TrackState::lost);
  gaps.push(t.lost(2));
  EXPECT_EQ(gaps.push(t.tracked(3)), 1U);
  frames = take(gaps);
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[0].motion.state, TrackState::tracking);
}

TEST(GapFiller, WhereTheBodyNoLongerFitsThePersonStaysLost) {
  const Tracked t(filling(10));
  // The person's clothes on the other side of the picture only.
  GapFrame other = t.lost(0);
  FrameFeatures elsewhere;
  elsewhere.labels = cv::Mat::zeros(other.seen->labels.size(), CV_8UC1);
  elsewhere.labels.colRange(0, 8).setTo(3);
  elsewhere.distance = other.seen->distance;
  other.seen = prepare(elsewhere, other.seen->camera);
  GapFiller gaps(t.tracker);
  gaps.push(t.lost(0));
  for (int i = 0; i < 3; ++i) {
    GapFrame frame = other;
    frame.decided.motion.frame = 1 + i;
    frame.decided.motion.time = (1 + i) / support::kClipFps;
    gaps.push(frame);
  }
  gaps.push(t.lost(4));
  EXPECT_EQ(gaps.push(t.tracked(5)), 1U) << "the patience of two frames is at its end before the first one";
  const auto frames = take(gaps);
  ASSERT_EQ(frames.size(), 6U);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(frames[i].motion.state, TrackState::lost) << i;
  }
}

TEST(GapFiller, NoMoreFramesWaitThanItMay) {
  const Tracked t(filling(2));
  GapFiller gaps(t.tracker);
  gaps.push(t.lost(0));
  gaps.push(t.lost(1));
  EXPECT_TRUE(take(gaps).empty());
  gaps.push(t.lost(2));
  auto frames = take(gaps);
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames[0].motion.state, TrackState::lost);
  gaps.finish();
  frames = take(gaps);
  ASSERT_EQ(frames.size(), 2U) << "nobody is found any more";
  EXPECT_EQ(frames[1].motion.frame, 2);
  EXPECT_EQ(frames[1].motion.state, TrackState::lost);
  EXPECT_EQ(gaps.push(t.tracked(3)), 0U) << "what was handed out stays as it was";
  EXPECT_EQ(take(gaps).size(), 1U);
}

TEST(GapFiller, WhatIsFollowedBackCanBeLookedBackOn) {
  Config config = filling(10);
  config.look_back = true;
  const Tracked t(config);
  GapFiller gaps(t.tracker);
  gaps.push(t.lost(3));
  gaps.push(t.lost(4));
  ASSERT_EQ(gaps.push(t.tracked(5)), 2U);
  OfflineTracker offline(t.tracker.config(), t.tracker.limits());
  for (OfflineFrame& frame : take(gaps)) {
    if (frame.motion.frame < 5) {
      ASSERT_TRUE(frame.stretch) << frame.motion.frame;
      EXPECT_FALSE(frame.stretch->candidates.empty());
      EXPECT_FALSE(frame.stretch->frame.labels.empty());
      offline.push(std::move(frame));
    }
  }
  offline.finish();
  for (std::int64_t index = 3; index < 5; ++index) {
    const auto frame = offline.next(t.tracker.model(), t.tracker.camera());
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->motion.frame, index);
    EXPECT_EQ(frame->motion.state, TrackState::tracking);
    EXPECT_LT(frame->motion.region_score, 0.3);
  }
}

TEST(GapFiller, SameSeedSamePosesForAnyNumberOfThreads) {
  const auto poses = [](int threads, std::uint64_t seed) {
    Config config = filling(10);
    config.threads = threads;
    const Tracked t(config);
    Config filling_config = config;
    filling_config.seed = seed;
    Tracker other = make_tracker(filling_config);
    other.set_calibration(*t.tracker.calibration(), t.tracker.features().calibration());
    GapFiller gaps(other);
    gaps.push(t.lost(3));
    gaps.push(t.lost(4));
    gaps.push(t.tracked(5));
    std::vector<double> all;
    for (const OfflineFrame& frame : take(gaps)) {
      const PoseVector v = frame.motion.pose.vector();
      all.insert(all.end(), v.begin(), v.end());
    }
    return all;
  };
  const auto first = poses(1, 1);
  EXPECT_EQ(first, poses(2, 1));
  EXPECT_NE(first, poses(1, 2)) << "the seed is used";
}

TEST(GapFiller, OfARealClipNoFrameWithAPersonIsLost) {
  const char* const variable = std::getenv("TELEMIME_DATA");
  const std::filesystem::path data = variable != nullptr ? variable : TELEMIME_SOURCE_DIR "/../shared/data";
  const std::filesystem::path file = data / "real/seated_stereo/clip.mp4";
  if (!std::filesystem::exists(file)) {
    const std::string reason = "no test data: set TELEMIME_DATA";
    std::cout << reason << '\n';
    GTEST_SKIP() << reason;
  }
  // A man with a mask walks in sideways and bends over a chair; where he sits, he is found.
  const ScratchFolder folder;
  TrackRequest request;
  request.input = file.string();
  request.out = folder.path();
  request.formats = {"jsonl"};
  request.overlay = false;
  request.most_frames = 60;
  request.config.field_of_view = 43.6;
  EXPECT_EQ(run_track(request, {}).tracked, 60) << "40 of them before he is found";
}

}  // namespace
}  // namespace telemime
