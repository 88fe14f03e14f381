// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracker/track_frame.h"

#include <gtest/gtest.h>

#include <array>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <thread>

#include "telemime/core/time_base.h"
#include "telemime/tracker/lost_and_found.h"
#include "track/quick_run.h"

namespace telemime {
namespace {

// The person, an empty scene, and the person again, numbered consecutively.
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

TEST(Tracker, TracksThePerson) {
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

TEST(Tracker, WithoutColoursTheirOverlapSaysNothingOfTheSpread) {
  const auto deviation = [](bool has_colours) {
    TrackingRun run = learned_run();
    track_frame(clip().person[0], run);
    PreparedFrame frame =
        prepare(extract(clip().person[1], ColourRequest::keep, run.scene), run.tracker.working_camera);
    frame.has_colours = has_colours;
    FilterResult found;
    found.pose = run.state.pose;
    found.score.costs[cue::kRegion] = 0.7;
    return std::sqrt(spread_of_filter(run.tracker, run.state, frame, run.state.filter, found)
                         .covariance[static_cast<std::size_t>(Joint::l_elbow)]
                         .trace());
  };
  EXPECT_LT(deviation(false), 0.8 * deviation(true));
}

TEST(Tracker, UsesItsIterations) {
  Config config = quick_config();
  config.tracking.method = "two-step";
  const auto motion = track(config, clip().person);
  for (std::size_t i = 1; i < motion.size(); ++i) {
    // Two more evaluations choose the start.
    EXPECT_LE(motion[i].evaluations, config.registration.iterations + 2) << i;
    EXPECT_FALSE(motion[i].spread) << "a single pose has no spread";
  }
}

TEST(Tracker, ThesisFilterUsesItsParticles) {
  Config config = quick_config();
  config.tracking.method = "condensation";
  config.filter.particles = 150;
  const auto motion = track(config, clip().person);
  for (std::size_t i = 1; i < motion.size(); ++i) {
    EXPECT_EQ(motion[i].evaluations, config.filter.particles) << i;
    EXPECT_TRUE(motion[i].spread) << i;
  }
}

TEST(Tracker, DefaultFilterUsesParticlesAndFlips) {
  const Config config = quick_config();
  const FilterConfig& filter = config.filter;
  const auto motion = track(config, clip().person);
  for (std::size_t i = 1; i < motion.size(); ++i) {
    // At most three trunks, each from one of two starts.
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

TEST(Tracker, EffortIsAShareOfTheSearch) {
  for (const char* method : {"heuristics", "two-step"}) {
    const auto evaluations = [&](double effort) {
      Config config = quick_config();
      config.tracking.method = method;
      TrackingRun run = learned_run(config);
      track_frame(clip().person[0], run);
      const FrameFeatures features = extract(clip().person[1], colour_request(run.state), run.scene);
      return estimate(features, run.tracker, run.state, effort).motion.evaluations;
    };
    const int whole = evaluations(1.0);
    EXPECT_LT(evaluations(0.25), 0.4 * whole) << method;
    EXPECT_GT(evaluations(0.5), 0.3 * whole) << method;
  }
}

TEST(Tracker, TracksAtFiveFramesPerSecond) {
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

TEST(Tracker, WiderImageGivesSameDistance) {
  // The same images with more of the wall on both sides: 16:9.
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
  TrackingRun run = make_tracking_run(quick_config(), camera);
  EXPECT_EQ(run.tracker.config.image.width, 184);
  EXPECT_EQ(run.tracker.config.image.height, 104);
  run.scene.features.learn_background(widened(clip().background));
  const auto usual = track(quick_config(), clip().person);
  const std::vector<Frame> frames = widened(clip().person);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const MotionFrame wide = track_frame(frames[i], run).estimate.motion;
    ASSERT_EQ(wide.state, TrackState::tracking) << i;
    EXPECT_NEAR(wide.joints[Joint::head].z() / usual[i].joints[Joint::head].z(), 1.0, 0.05) << i;
  }
}

TEST(Tracker, OneBadFrameLosesNoPerson) {
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

TEST(Tracker, SameSeedGivesSameMotion) {
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

TEST(Tracker, LosesAndFindsThePerson) {
  const auto frames = coming_and_going(8);
  TrackingRun run = learned_run();
  std::vector<FrameEstimate> results;
  for (const Frame& frame : frames) {
    results.push_back(track_frame(frame, run).estimate);
  }
  const std::size_t gone = kPersonFrames + 7;  // the last frame without the person
  EXPECT_EQ(results[kPersonFrames - 1].motion.state, TrackState::tracking);
  EXPECT_EQ(results[gone].motion.state, TrackState::lost);
  EXPECT_EQ(results.back().motion.state, TrackState::tracking);
  EXPECT_TRUE(results.back().note.empty());
  for (const FrameEstimate& r : results) {
    EXPECT_TRUE(r.motion.pose.vector().allFinite());
    EXPECT_EQ(r.note.empty(), r.motion.state == TrackState::tracking) << "why nobody is tracked";
  }
}

TEST(Tracker, EmptySceneIsNotTracked) {
  const std::vector<Frame> empty(clip().background.begin(), clip().background.begin() + 4);
  for (const MotionFrame& m : track(quick_config(), empty)) {
    EXPECT_EQ(m.state, TrackState::lost);
    EXPECT_TRUE(m.pose.vector().allFinite());
  }
}

TEST(Tracker, BlackFramesAreNotTracked) {
  TrackingRun run = quick_run(quick_config());  // also without a background
  for (int i = 0; i < 4; ++i) {
    const Frame black = {cv::Mat::zeros(240, 320, CV_8UC3), i, i / support::kClipFps};
    const FrameRecord result = track_frame(black, run);
    EXPECT_EQ(result.estimate.motion.state, TrackState::lost);
    EXPECT_FALSE(result.estimate.note.empty());
  }
}

TEST(Tracker, UsesCalibrationOfAnotherRun) {
  TrackingRun first = learned_run();
  track_frame(clip().person.front(), first);
  ASSERT_TRUE(first.state.person);
  TrackingRun second = quick_run(quick_config());
  use_calibration(*first.state.person, first.scene.features.calibration(), second);
  const FrameRecord found = track_frame(clip().person[1], second);
  EXPECT_EQ(found.estimate.motion.state, TrackState::tracking) << found.estimate.note;
  EXPECT_EQ(second.state.model.body.shape[Segment::l_forearm].length,
            first.state.person->shape[Segment::l_forearm].length);
}

TEST(Tracker, ParallelStagesEqualSequentialOnes) {
  TrackingRun in_turn = learned_run();
  TrackingRun beside = learned_run();
  std::array<FrameFeatures, 2> seen;
  const std::vector<Frame>& frames = clip().person;
  seen[0] = extract(frames.front(), colour_request(beside.state), beside.scene);
  int together = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    FrameFeatures& now = seen[i % 2];
    FrameFeatures& next = seen[(i + 1) % 2];
    const bool last = i + 1 == frames.size();
    std::thread image_side;
    if (beside.state.calibrated() && !last) {
      ++together;
      image_side = std::thread([&] { next = extract(frames[i + 1], ColourRequest::keep, beside.scene); });
    }
    const FrameEstimate ours = estimate(now, beside.tracker, beside.state);
    if (image_side.joinable()) {
      image_side.join();
    } else if (!last) {
      next = extract(frames[i + 1], colour_request(beside.state), beside.scene);
    }
    const FrameRecord theirs = track_frame(frames[i], in_turn);
    ASSERT_EQ(ours.motion.state, theirs.estimate.motion.state) << i;
    ASSERT_EQ(ours.motion.pose.vector(), theirs.estimate.motion.pose.vector()) << i;
    ASSERT_EQ(ours.note, theirs.estimate.note) << i;
  }
  EXPECT_GT(together, 3);
}

TEST(Tracker, StartsWithKnownPerson) {
  TrackingRun first = learned_run();
  const FrameRecord start = track_frame(clip().person.front(), first);
  ASSERT_TRUE(first.state.person);
  KnownStart known = {.person = *first.state.person,
                      .frame = start.estimate.motion.frame,
                      .pose = start.estimate.motion.pose};
  known.person.shape[Segment::l_forearm].length *= 1.02;

  TrackingRun second = learned_run();
  second.state.known_start = known;
  const FrameRecord taken = track_frame(clip().person.front(), second);
  EXPECT_EQ(taken.estimate.motion.state, TrackState::tracking);
  EXPECT_EQ(taken.estimate.motion.pose.vector(), known.pose.vector());
  EXPECT_EQ(second.state.person->shape[Segment::l_forearm].length,
            known.person.shape[Segment::l_forearm].length);
  EXPECT_EQ(track_frame(clip().person[1], second).estimate.motion.state, TrackState::tracking);
}

TEST(Tracker, TracksKnownPersonBeforeFittedFrame) {
  TrackingRun first = learned_run();
  const FrameRecord start = track_frame(clip().person.front(), first);
  ASSERT_TRUE(first.state.person);
  KnownStart known = {
      .person = *first.state.person, .frame = 5, .pose = start.estimate.motion.pose, .visible_since = 0};
  known.person.shape[Segment::l_forearm].length *= 1.02;
  const auto forearm_at_first = [&](std::int64_t since) {
    known.visible_since = since;
    TrackingRun second = learned_run();
    second.state.known_start = known;
    EXPECT_EQ(track_frame(clip().person.front(), second).estimate.motion.state, TrackState::tracking);
    return second.state.person->shape[Segment::l_forearm].length;
  };
  EXPECT_EQ(forearm_at_first(0), known.person.shape[Segment::l_forearm].length);
  EXPECT_NE(forearm_at_first(5), known.person.shape[Segment::l_forearm].length);
}

TEST(Tracker, KeepsSceneOfAnotherTrackerUnchanged) {
  TrackingRun first = learned_run();
  const cv::Mat before = first.scene.features.calibration().background.mean.l.clone();
  TrackingRun second = quick_run(quick_config());
  second.scene.features.set_calibration(first.scene.features.calibration());
  for (const Frame& frame : clip().person) {
    track_frame(frame, second);
  }
  const cv::Mat& after = first.scene.features.calibration().background.mean.l;
  EXPECT_EQ(cv::norm(before, after, cv::NORM_INF), 0.0);
  EXPECT_GT(cv::norm(before, second.scene.features.calibration().background.mean.l, cv::NORM_INF), 0.0)
      << "it adapts to the light";
}

}  // namespace
}  // namespace telemime
