// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracker/tracker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <thread>

#include "track/quick_tracker.h"

namespace telemime {
namespace {

std::vector<MotionFrame> track(const Config& config, const std::vector<Frame>& frames) {
  Tracker tracker = make_tracker(config);
  tracker.learn_background(clip().background);
  std::vector<MotionFrame> motion;
  for (const Frame& frame : frames) {
    motion.push_back(tracker.step(frame).motion);
  }
  return motion;
}

// The person, then nobody, then the person again; numbered through.
std::vector<Frame> coming_and_going(int away) {
  std::vector<Frame> frames = clip().person;
  for (int i = 0; i < away; ++i) {
    frames.push_back(clip().background[static_cast<std::size_t>(i) % clip().background.size()]);
  }
  for (int i = 0; i < 4; ++i) {
    frames.push_back(clip().person.back());
  }
  for (std::size_t i = 0; i < frames.size(); ++i) {
    frames[i].index = static_cast<std::int64_t>(i);
    frames[i].time = static_cast<double>(i) / support::kClipFps;
  }
  return frames;
}

TEST(Tracker, FollowsThePerson) {
  const auto motion = track(quick_config(), clip().person);
  ASSERT_EQ(motion.size(), clip().person.size());
  const Camera& camera = clip().camera;
  for (std::size_t i = 0; i < motion.size(); ++i) {
    const MotionFrame& m = motion[i];
    EXPECT_EQ(m.state, TrackState::tracking) << i;
    EXPECT_EQ(m.frame, static_cast<std::int64_t>(i));
    EXPECT_TRUE(m.pose.vector().allFinite());
    EXPECT_TRUE(anatomical_limits().contains(m.pose, 1e-6)) << i;
    EXPECT_GT(m.region_score, 0.0);
    EXPECT_LT(m.region_score, 0.5);
    EXPECT_GT(m.evaluations, 50);
    const JointPositions truth = clip().truth[i];
    for (const Joint j : {Joint::neck, Joint::head, Joint::l_shoulder, Joint::r_shoulder}) {
      const auto at = static_cast<std::size_t>(j);
      EXPECT_LT((m.pixels[at] - camera.project(truth[j])).norm(), 25.0) << kJointNames[at] << " " << i;
    }
  }
}

TEST(Tracker, SpendsItsIterationsAndLittleMore) {
  Config config = quick_config();
  config.tracking.method = "two-step";
  const auto motion = track(config, clip().person);
  for (std::size_t i = 1; i < motion.size(); ++i) {
    // Two more look at where to start.
    EXPECT_LE(motion[i].evaluations, config.registration.iterations + 2) << i;
    EXPECT_FALSE(motion[i].spread) << "one pose alone knows no doubt";
  }
}

TEST(Tracker, TheThesissFilterSpendsItsParticles) {
  Config config = quick_config();
  config.tracking.method = "condensation";
  config.filter.particles = 150;
  const auto motion = track(config, clip().person);
  for (std::size_t i = 1; i < motion.size(); ++i) {
    EXPECT_EQ(motion[i].evaluations, config.filter.particles) << i;
    EXPECT_TRUE(motion[i].spread) << i;
  }
}

TEST(Tracker, OurFilterSpendsItsParticlesAndWhatItTurnsAndFlips) {
  const Config config = quick_config();
  const FilterConfig& filter = config.filter;
  const auto motion = track(config, clip().person);
  for (std::size_t i = 1; i < motion.size(); ++i) {
    // Three trunks at most, each from one of two starts.
    const int turned = filter.turn_evaluations + 2 * filter.walk_evaluations + 3 * 2;
    EXPECT_LE(motion[i].evaluations,
              filter.particles + turned + 15 * filter.flip_candidates + 2 * filter.mode_least)
        << i;
    EXPECT_GE(motion[i].evaluations, filter.particles) << i;
    ASSERT_TRUE(motion[i].spread) << i;
    EXPECT_GE(motion[i].spread->effective_particles, 1.0 - 1e-9);
    for (const Eigen::Matrix3d& covariance : motion[i].spread->covariance) {
      EXPECT_TRUE(covariance.allFinite());
      EXPECT_GT(covariance.determinant(), 0.0);
    }
  }
}

TEST(Tracker, TheEffortIsAShareOfTheSearch) {
  for (const char* method : {"heuristics", "two-step"}) {
    const auto evaluations = [&](double effort) {
      Config config = quick_config();
      config.tracking.method = method;
      Tracker tracker = make_tracker(config);
      tracker.learn_background(clip().background);
      tracker.set_effort(effort);
      tracker.step(clip().person[0]);
      return tracker.step(clip().person[1]).motion.evaluations;
    };
    const int whole = evaluations(1.0);
    EXPECT_LT(evaluations(0.25), 0.4 * whole) << method;
    EXPECT_GT(evaluations(0.5), 0.3 * whole) << method;
  }
}

TEST(Tracker, AtFiveFramesASecondThePersonIsFollowedToo) {
  std::vector<Frame> frames = clip().person;
  for (Frame& frame : frames) {
    frame.time *= 5.0;
  }
  const auto slow = track(quick_config(), frames);
  const auto usual = track(quick_config(), clip().person);
  for (std::size_t i = 0; i < slow.size(); ++i) {
    EXPECT_EQ(slow[i].state, TrackState::tracking) << i;
    EXPECT_LT(slow[i].region_score, 0.5) << i;
    EXPECT_EQ(slow[i].pose.vector() == usual[i].pose.vector(), i == 0) << i;
  }
}

TEST(Tracker, AWiderPictureShowsThePersonAtTheSameDistance) {
  // The same pictures with more of the wall beside them: 16:9.
  constexpr int kBorder = 53;
  const auto widened = [](std::vector<Frame> frames) {
    for (Frame& frame : frames) {
      cv::Mat wide;
      cv::copyMakeBorder(frame.image, wide, 0, 0, kBorder, kBorder, cv::BORDER_REPLICATE);
      frame.image = wide;
    }
    return frames;
  };
  Camera camera = clip().camera;
  camera.width += 2 * kBorder;
  camera.cx += kBorder;
  Tracker tracker(quick_config(), camera);
  EXPECT_EQ(tracker.config().image.width, 184);
  EXPECT_EQ(tracker.config().image.height, 104);
  tracker.learn_background(widened(clip().background));
  const auto usual = track(quick_config(), clip().person);
  const std::vector<Frame> frames = widened(clip().person);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const MotionFrame wide = tracker.step(frames[i]).motion;
    ASSERT_EQ(wide.state, TrackState::tracking) << i;
    EXPECT_NEAR(wide.joints[Joint::head].z() / usual[i].joints[Joint::head].z(), 1.0, 0.05) << i;
  }
}

TEST(Tracker, OneBadFrameLosesNobodyHoweverLongItLasts) {
  for (const char* method : {"two-step", "heuristics"}) {
    Config config = quick_config();
    config.tracking.method = method;
    config.tracking.lost_region = 1e-6;  // every frame is bad
    std::vector<Frame> frames(clip().person.begin(), clip().person.begin() + 3);
    for (Frame& frame : frames) {
      frame.time *= 12.5;
    }
    const auto motion = track(config, frames);
    EXPECT_EQ(motion[1].state, TrackState::tracking) << method << ": one bad frame of half a second";
    EXPECT_EQ(motion[2].state, TrackState::lost) << method << ": two in a row";
  }
}

TEST(TimeStep, IsOneWhereItIsUsualOrNotKnown) {
  EXPECT_EQ(steps_between(0.0, 0.04), 1.0);
  EXPECT_EQ(steps_between(1.0, 1.0415), 1.0);  // a camera's clock
  EXPECT_EQ(steps_between(7.0, 7.0), 1.0);
  EXPECT_EQ(steps_between(7.0, 3.0), 1.0);
  EXPECT_NEAR(steps_between(1.0, 1.2), 5.0, 1e-9);
  EXPECT_NEAR(steps_between(1.0, 1.0 + 1.0 / 30.0), 25.0 / 30.0, 1e-9);
  EXPECT_EQ(steps_between(0.0, 100.0), 8.0);
  EXPECT_EQ(steps_between(0.0, 0.001), 0.2);
}

TEST(Tracker, SameSeedSameMotion) {
  const std::vector<Frame> frames(clip().person.begin(), clip().person.begin() + 4);
  const auto a = track(quick_config(), frames);
  const auto b = track(quick_config(), frames);
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a[i].pose.vector(), b[i].pose.vector()) << i;
    ASSERT_EQ(a[i].region_score, b[i].region_score);
    ASSERT_EQ(a[i].evaluations, b[i].evaluations);
    ASSERT_EQ(a[i].state, b[i].state);
  }
  Config other = quick_config();
  other.seed = 2;
  EXPECT_NE(track(other, frames).back().pose.vector(), a.back().pose.vector()) << "the seed is used";
}

TEST(Tracker, LosesThePersonAndFindsThemAgain) {
  const auto frames = coming_and_going(8);
  Tracker tracker = make_tracker(quick_config());
  tracker.learn_background(clip().background);
  std::vector<TrackedFrame> results;
  for (const Frame& frame : frames) {
    results.push_back(tracker.step(frame));
  }
  const std::size_t gone = kPersonFrames + 7;  // the last frame without the person
  EXPECT_EQ(results[kPersonFrames - 1].motion.state, TrackState::tracking);
  EXPECT_EQ(results[gone].motion.state, TrackState::lost);
  EXPECT_FALSE(results[gone].note.empty()) << "a reason is given";
  EXPECT_EQ(results.back().motion.state, TrackState::tracking);
  EXPECT_TRUE(results.back().note.empty());
  for (const TrackedFrame& r : results) {
    EXPECT_TRUE(r.motion.pose.vector().allFinite());
  }
}

TEST(Tracker, NobodyIsNotTracked) {
  const std::vector<Frame> empty(clip().background.begin(), clip().background.begin() + 4);
  for (const MotionFrame& m : track(quick_config(), empty)) {
    EXPECT_EQ(m.state, TrackState::lost);
    EXPECT_TRUE(m.pose.vector().allFinite());
  }
}

TEST(Tracker, BlackFramesAreNotTracked) {
  Tracker tracker = make_tracker(quick_config());  // without a background, too
  for (int i = 0; i < 4; ++i) {
    const Frame black = {cv::Mat::zeros(240, 320, CV_8UC3), i, i / support::kClipFps};
    const TrackedFrame result = tracker.step(black);
    EXPECT_EQ(result.motion.state, TrackState::lost);
    EXPECT_FALSE(result.note.empty());
  }
}

TEST(Tracker, CalibrationOfAnotherRunIsTakenOver) {
  Tracker first = make_tracker(quick_config());
  first.learn_background(clip().background);
  first.step(clip().person.front());
  ASSERT_TRUE(first.calibration());
  Tracker second = make_tracker(quick_config());
  second.set_calibration(*first.calibration(), first.features().calibration());
  const TrackedFrame found = second.step(clip().person[1]);
  EXPECT_EQ(found.motion.state, TrackState::tracking) << found.note;
  EXPECT_EQ(second.model().body.shape[Segment::l_forearm].length,
            first.calibration()->shape[Segment::l_forearm].length);
}

TEST(Tracker, ImageAndSearchSideBySideGiveWhatTheyGiveInTurn) {
  Tracker in_turn = make_tracker(quick_config());
  in_turn.learn_background(clip().background);
  Tracker beside = make_tracker(quick_config());
  beside.learn_background(clip().background);
  std::array<SeenFrame, 2> seen;
  const std::vector<Frame>& frames = clip().person;
  beside.look(frames.front(), beside.settled(), seen[0]);
  int together = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    SeenFrame& now = seen[i % 2];
    SeenFrame& next = seen[(i + 1) % 2];
    const bool last = i + 1 == frames.size();
    std::thread image_side;
    if (beside.settled() && !last) {
      ++together;
      image_side = std::thread([&] { beside.look(frames[i + 1], true, next); });
    }
    const TrackedFrame ours = beside.decide(now);
    if (image_side.joinable()) {
      image_side.join();
    } else if (!last) {
      beside.look(frames[i + 1], beside.settled(), next);
    }
    const TrackedFrame theirs = in_turn.step(frames[i]);
    ASSERT_EQ(ours.motion.state, theirs.motion.state) << i;
    ASSERT_EQ(ours.motion.pose.vector(), theirs.motion.pose.vector()) << i;
    ASSERT_EQ(ours.note, theirs.note) << i;
  }
  EXPECT_GT(together, 3);
}

TEST(Tracker, StartsWithAPersonWhoIsKnown) {
  Tracker first = make_tracker(quick_config());
  first.learn_background(clip().background);
  const TrackedFrame start = first.step(clip().person.front());
  ASSERT_TRUE(first.calibration());
  KnownStart known = {*first.calibration(), start.motion.frame, start.motion.pose};
  known.person.shape[Segment::l_forearm].length *= 1.02;

  Tracker second = make_tracker(quick_config());
  second.learn_background(clip().background);
  second.start_with(known);
  const TrackedFrame taken = second.step(clip().person.front());
  EXPECT_EQ(taken.motion.state, TrackState::tracking);
  EXPECT_EQ(taken.motion.pose.vector(), known.pose.vector());
  EXPECT_EQ(second.calibration()->shape[Segment::l_forearm].length,
            known.person.shape[Segment::l_forearm].length);
  EXPECT_EQ(second.step(clip().person[1]).motion.state, TrackState::tracking);
}

TEST(Tracker, APersonWhoIsKnownIsTrackedBeforeTheFrameThatTheShapeWasFittedTo) {
  Tracker first = make_tracker(quick_config());
  first.learn_background(clip().background);
  const TrackedFrame start = first.step(clip().person.front());
  ASSERT_TRUE(first.calibration());
  KnownStart known = {*first.calibration(), 5, start.motion.pose, 0};
  known.person.shape[Segment::l_forearm].length *= 1.02;
  const auto forearm_at_first = [&](std::int64_t since) {
    known.since = since;
    Tracker second = make_tracker(quick_config());
    second.learn_background(clip().background);
    second.start_with(known);
    EXPECT_EQ(second.step(clip().person.front()).motion.state, TrackState::tracking);
    return second.calibration()->shape[Segment::l_forearm].length;
  };
  EXPECT_EQ(forearm_at_first(0), known.person.shape[Segment::l_forearm].length);
  EXPECT_NE(forearm_at_first(5), known.person.shape[Segment::l_forearm].length);
}

TEST(Tracker, TheSceneOfAnotherTrackerIsNotChangedByThisOne) {
  Tracker first = make_tracker(quick_config());
  first.learn_background(clip().background);
  const cv::Mat before = first.features().calibration().background.mean.l.clone();
  Tracker second = make_tracker(quick_config());
  second.set_scene(first.features().calibration());
  for (const Frame& frame : clip().person) {
    second.step(frame);
  }
  const cv::Mat& after = first.features().calibration().background.mean.l;
  EXPECT_EQ(cv::norm(before, after, cv::NORM_INF), 0.0);
  EXPECT_GT(cv::norm(before, second.features().calibration().background.mean.l, cv::NORM_INF), 0.0)
      << "it does follow the light";
}

}  // namespace
}  // namespace telemime
