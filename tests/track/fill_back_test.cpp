// SPDX-License-Identifier: Apache-2.0
#include "telemime/offline/fill_back.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <utility>
#include <vector>

#include "support/needs.h"
#include "telemime/core/scratch_folder.h"
#include "telemime/likelihood/testing_landmarks.h"
#include "telemime/offline/choose_poses.h"
#include "telemime/offline/track_file.h"
#include "track/quick_run.h"

namespace telemime {
namespace {

Config filling(int most) {
  Config config = quick_config();
  config.tracking.fill_back = most;
  return config;
}

// A run with a calibrated person, and the records of the clip.
struct Tracked {
  explicit Tracked(const Config& config) : run(quick_run(config)), seeds(fill_back_seeds(config)) {
    run.scene.features.learn_background(clip().background);
    for (const Frame& frame : clip().person) {
      records.push_back(track_frame(frame, run));
      EXPECT_EQ(records.back().estimate.motion.state, TrackState::tracking) << frame.index;
    }
  }
  // The record of a frame in which the person is visible but not found.
  FrameRecord lost(std::size_t index) const {
    FrameRecord record = records.at(index);
    record.estimate.motion.state = TrackState::lost;
    record.estimate.motion.pose = Pose{};
    record.estimate.motion.spread.reset();
    record.estimate.note = "not found";
    return record;
  }
  FrameRecord tracked(std::size_t index) const { return records.at(index); }

  std::size_t push(FrameRecord record) {
    queue.records.push_back(std::move(record));
    return fill_back(run.tracker, run.state, seeds, queue);
  }
  // Removes and returns the records that are final.
  std::vector<FrameRecord> take() {
    std::vector<FrameRecord> taken;
    for (; queue.filled > 0; --queue.filled) {
      taken.push_back(std::move(queue.records.front()));
      queue.records.pop_front();
    }
    return taken;
  }

  TrackingRun run;
  std::vector<FrameRecord> records;
  Random seeds;
  RecordQueue queue;
};

TEST(FillBack, FollowsTheFoundPersonBack) {
  Tracked t(filling(10));
  for (std::size_t i = 0; i + 1 < kPersonFrames; ++i) {
    EXPECT_EQ(t.push(t.lost(i)), 0U);
    EXPECT_TRUE(t.take().empty()) << i;
  }
  EXPECT_EQ(t.push(t.tracked(kPersonFrames - 1)), kPersonFrames - 1U);
  const auto records = t.take();
  ASSERT_EQ(records.size(), static_cast<std::size_t>(kPersonFrames));
  for (std::size_t i = 0; i < records.size(); ++i) {
    const MotionFrame& motion = records[i].estimate.motion;
    EXPECT_EQ(motion.frame, static_cast<std::int64_t>(i));
    EXPECT_EQ(motion.state, TrackState::tracking) << i;
    EXPECT_EQ(records[i].estimate.note, "") << i;
    EXPECT_TRUE(motion.spread) << i;
    for (const Joint joint : {Joint::l_elbow, Joint::r_elbow, Joint::l_wrist, Joint::r_wrist}) {
      const Eigen::Vector2d seen = clip().camera.project(clip().truth[i][joint]);
      EXPECT_LT((motion.pixels[static_cast<std::size_t>(joint)] - seen).norm(), 20.0)
          << "frame " << i << ", joint " << static_cast<int>(joint);
    }
  }
}

// A hand as a network sees it: open, at the wrist.
HandLandmarks open_hand(const JointPositions& joints, const Camera& camera) {
  Eigen::Isometry3d place = Eigen::Isometry3d::Identity();
  place.translation() = joints[Joint::l_wrist];
  const HandPoints points = hand_points(average_hand(1.7), resting_hand(), Side::left, place);
  HandLandmarks hand;
  hand.presence = 0.95;
  hand.is_right = 0.05;
  hand.region = {.centre = camera.project(points[9]), .width = 60.0, .height = 60.0};
  for (std::size_t i = 0; i < kHandJointCount; ++i) {
    hand.points[i] = {.pixel = camera.project(points[i]), .world = points[i] - points[9]};
  }
  return hand;
}

TEST(FillBack, TheirHandsAreThoseThatWereSeen) {
  Tracked t(filling(10));
  for (std::size_t i = 0; i + 1 < kPersonFrames; ++i) {
    FrameRecord lost = t.lost(i);
    lost.features.hands.emplace();
    (*lost.features.hands)[0] = {.looked = true,
                                 .found = open_hand(clip().truth[i], t.run.tracker.working_camera)};
    lost.estimate.motion.hands.emplace();
    t.push(lost);
  }
  t.push(t.tracked(kPersonFrames - 1));
  auto records = t.take();
  records.pop_back();
  for (const FrameRecord& record : records) {
    EXPECT_GT((*record.estimate.motion.hands)[0].visibility, 0.5) << record.estimate.motion.frame;
    EXPECT_EQ((*record.estimate.motion.hands)[1].visibility, 0.0);
  }
}

TEST(FillBack, StopsWhereNoPersonIsVisible) {
  Tracked t(filling(10));
  t.push(t.lost(0));
  FrameRecord empty = t.lost(1);
  empty.features.person_present = false;
  t.push(empty);
  auto records = t.take();
  ASSERT_EQ(records.size(), 2U) << "the person cannot be followed back to these";
  EXPECT_EQ(records[0].estimate.motion.state, TrackState::lost);
  EXPECT_EQ(records[0].estimate.note, "not found");
  EXPECT_EQ(records[1].estimate.motion.state, TrackState::lost);
  t.push(t.lost(2));
  EXPECT_EQ(t.push(t.tracked(3)), 1U);
  records = t.take();
  ASSERT_EQ(records.size(), 2U);
  EXPECT_EQ(records[0].estimate.motion.state, TrackState::tracking);
}

TEST(FillBack, StopsAtAPause) {
  Tracked t(filling(10));
  FrameRecord before = t.lost(0);
  before.estimate.motion.time -= 15.0;
  t.push(before);
  t.push(t.lost(1));
  EXPECT_EQ(t.push(t.tracked(2)), 1U);
}

TEST(FillBack, StopsWhereTheBodyNoLongerFits) {
  Tracked t(filling(10));
  // Only clothes, on the other side of the image.
  FrameRecord other = t.lost(0);
  FrameFeatures elsewhere;
  elsewhere.labels = cv::Mat::zeros(other.estimate.prepared->labels.size(), CV_8UC1);
  elsewhere.labels.colRange(0, 8).setTo(3);
  elsewhere.distance = other.estimate.prepared->distance;
  other.estimate.prepared = prepare(elsewhere, other.estimate.prepared->camera);
  t.push(t.lost(0));
  for (int i = 0; i < 3; ++i) {
    FrameRecord record = other;
    record.estimate.motion.frame = 1 + i;
    record.estimate.motion.time = (1 + i) / support::kClipFps;
    t.push(record);
  }
  t.push(t.lost(4));
  EXPECT_EQ(t.push(t.tracked(5)), 1U) << "the patience of two frames ends before the first one";
  const auto records = t.take();
  ASSERT_EQ(records.size(), 6U);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(records[i].estimate.motion.state, TrackState::lost) << i;
  }
}

TEST(FillBack, LandmarksVouchForFramesWithoutColours) {
  for (const bool landmarks : {true, false}) {
    Tracked t(filling(10));
    for (std::size_t i = 0; i + 1 < kPersonFrames; ++i) {
      FrameRecord record = t.lost(i);
      PreparedFrame& frame = *record.estimate.prepared;
      frame = [&] {
        FrameFeatures grey;
        grey.labels = frame.labels.clone();
        grey.labels.setTo(static_cast<unsigned char>(Label::ignore), frame.labels != 0);
        grey.distance = frame.distance;
        grey.has_colour_model = false;
        PreparedFrame prepared = prepare(grey, frame.camera);
        if (landmarks) {
          prepared.landmarks = testing_landmarks::perfect_landmarks(
              t.run.state.model.body, t.tracked(i).estimate.motion.pose, frame.camera);
        }
        return prepared;
      }();
      t.push(std::move(record));
    }
    const std::size_t filled = t.push(t.tracked(kPersonFrames - 1));
    EXPECT_EQ(filled > 0, landmarks) << filled;
  }
}

TEST(FillBack, LimitsTheWaitingFrames) {
  Tracked t(filling(2));
  t.push(t.lost(0));
  t.push(t.lost(1));
  EXPECT_TRUE(t.take().empty());
  t.push(t.lost(2));
  auto records = t.take();
  ASSERT_EQ(records.size(), 1U);
  EXPECT_EQ(records[0].estimate.motion.state, TrackState::lost);
  end_fill_back(t.run.tracker, t.queue);
  records = t.take();
  ASSERT_EQ(records.size(), 2U) << "no person is found any more";
  EXPECT_EQ(records[1].estimate.motion.frame, 2);
  EXPECT_EQ(records[1].estimate.motion.state, TrackState::lost);
  EXPECT_EQ(t.push(t.tracked(3)), 0U) << "removed records do not change";
  EXPECT_EQ(t.take().size(), 1U);
}

TEST(FillBack, HoldsNoMoreFramesOfAFastInput) {
  Tracked t(filling(1000));
  for (std::size_t i = 0; i < kMostWaiting + 10; ++i) {
    FrameRecord record = t.lost(0);
    record.estimate.motion.time = 0.001 * static_cast<double>(i);
    t.push(std::move(record));
  }
  EXPECT_EQ(t.take().size(), 10U);
}

TEST(FillBack, FilledFramesCanBeChosen) {
  Config config = filling(10);
  config.look_back = true;
  Tracked t(config);
  t.push(t.lost(3));
  t.push(t.lost(4));
  ASSERT_EQ(t.push(t.tracked(5)), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_FALSE(t.queue.records[i].estimate.modes.empty());
    ASSERT_TRUE(t.queue.records[i].estimate.prepared);
  }
  WindowState window(t.run.tracker.config);
  choose_poses(t.run.tracker, t.run.state.model, true, window, t.queue);
  ASSERT_EQ(t.queue.chosen, 3U);
  for (std::size_t i = 0; i < 2; ++i) {
    const MotionFrame& motion = t.queue.records[i].estimate.motion;
    EXPECT_EQ(motion.frame, static_cast<std::int64_t>(i + 3));
    EXPECT_EQ(motion.state, TrackState::tracking);
    EXPECT_LT(motion.region_score, 0.3);
  }
}

TEST(FillBack, SameSeedSamePosesForAnyThreads) {
  const auto poses = [](int threads, std::uint64_t seed) {
    Config config = filling(10);
    config.threads = threads;
    Tracked t(config);
    config.seed = seed;
    t.seeds = fill_back_seeds(config);
    for (std::size_t i = 0; i + 1 < kPersonFrames; ++i) {
      t.push(t.lost(i));
    }
    t.push(t.tracked(kPersonFrames - 1));
    std::vector<double> all;
    for (const FrameRecord& record : t.take()) {
      const PoseVector v = record.estimate.motion.pose.vector();
      all.insert(all.end(), v.begin(), v.end());
    }
    return all;
  };
  const auto first = poses(1, 1);
  EXPECT_EQ(first, poses(2, 1));
  EXPECT_NE(first, poses(1, 2)) << "the seed is used";
}

TEST(FillBack, LosesNoPersonInARealClip) {
  const std::filesystem::path file = support::test_data() / "real/seated_stereo/clip.mp4";
  if (!std::filesystem::exists(file)) {
    GTEST_SKIP() << support::kNoClips;
  }
  // A man with a mask walks in sideways and bends over a chair. He is found once he sits.
  const ScratchFolder folder;
  TrackRequest request;
  request.input = file.string();
  request.out = folder.path();
  request.formats = {"jsonl"};
  request.overlay = false;
  request.most_frames = 60;
  request.config.field_of_view = 43.6;
  EXPECT_EQ(track_file(request, {}).tracked, 60) << "40 of these before he is found";
}

}  // namespace
}  // namespace telemime
