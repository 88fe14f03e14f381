// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracker/lost_and_found.h"

#include <gtest/gtest.h>

#include "telemime/core/time_base.h"
#include "track/quick_run.h"

namespace telemime {
namespace {

// Where neither colours nor landmarks show anything, the last pose stays for the patience alone.
TEST(LostAndFound, PersonWhomNothingShowsIsLost) {
  for (const bool present : {true, false}) {
    TrackingRun run = learned_run();
    track_frame(clip().person[0], run);
    ASSERT_EQ(run.state.phase, Phase::tracking);
    std::string states;
    for (std::size_t i = 1; i < 4; ++i) {
      FrameFeatures features = extract(clip().person[i], ColourRequest::keep, run.scene);
      features.has_colour_model = false;
      features.person_present = present;
      const FrameEstimate unseen = estimate(features, run.tracker, run.state);
      states += unseen.motion.state == TrackState::tracking ? 't' : 'l';
      EXPECT_TRUE(unseen.note.empty() || states.back() == 'l') << unseen.note;
      EXPECT_TRUE(unseen.motion.region_score == 1.0 || states.back() == 'l') << "nothing fits it";
    }
    EXPECT_EQ(states, present ? "tll" : "lll");
  }
}

TEST(LostAndFound, HeadAloneDoesNotVouchForABody) {
  const auto state_with = [](std::size_t seen) {
    TrackingRun run = learned_run();
    track_frame(clip().person[0], run);
    FrameFeatures features = extract(clip().person[1], ColourRequest::keep, run.scene);
    FrameEstimate result;
    result.prepared = prepare(features, run.tracker.working_camera);
    result.motion.region_score = 1.0;  // the labels say that nothing fits
    result.prepared->landmarks.emplace();
    for (std::size_t i = 0; i < seen; ++i) {
      result.prepared->landmarks->points[i].seen = true;
    }
    Score score;
    score.costs[cue::kLandmarks] = 0.5;
    for (int i = 0; i < 3 && run.state.phase == Phase::tracking; ++i) {
      check_fit(features, score, run.tracker, run.state, result);
    }
    return run.state.phase;
  };
  EXPECT_EQ(state_with(kLandmarkCount), Phase::tracking);
  EXPECT_EQ(state_with(5), Phase::lost);
}

TEST(LostAndFound, WhoeverComesBackLaterHasANewFaceAndHands) {
  for (const double away : {1.0, 6.0}) {  // s
    TrackingRun run = learned_run();
    track_frame(clip().person[0], run);
    ASSERT_EQ(run.state.phase, Phase::tracking);
    run.state.hands.frames = 100.0;
    run.state.phase = Phase::lost;
    run.state.lost_for = kUnitsPerSecond * away;
    track_frame(clip().person[1], run);
    ASSERT_EQ(run.state.phase, Phase::tracking);
    EXPECT_EQ(run.state.hands.frames, away < 3.0 ? 100.0 : 0.0);
    EXPECT_EQ(run.state.lost_for, 0.0);
  }
}

TEST(LostAndFound, WhoeverComesBackIsExpectedToFaceTheCamera) {
  TrackingRun run = learned_run();
  track_frame(clip().person[0], run);
  run.state.phase = Phase::lost;
  run.state.heading = 1.0;  // of the person who walked out
  FrameEstimate found = track_frame(clip().person[1], run).estimate;
  ASSERT_EQ(run.state.phase, Phase::tracking);
  EXPECT_EQ(run.state.heading, 0.0);
}

TEST(LostAndFound, SomebodyElseHasTheirOwnColoursAndTheBodyMayNotFit) {
  TrackingRun run = learned_run();
  const auto warnings = [&run](bool other, bool calibrated) {
    FrameFeatures features;
    features.other_person = other;
    note_other_person(calibrated, run.scene, features);
    return features.warnings.size();
  };
  EXPECT_EQ(warnings(false, true), 0U);
  EXPECT_FALSE(run.scene.relearn_colours);
  EXPECT_EQ(warnings(true, false), 0U) << "no body that could be somebody else's";
  EXPECT_TRUE(run.scene.relearn_colours);
  EXPECT_EQ(warnings(true, true), 1U);
  EXPECT_EQ(warnings(false, true), 1U) << "until the next calibration";
  forget_person(run);
  EXPECT_EQ(warnings(false, true), 0U);
}

TEST(LostAndFound, SomebodyElseHasTheirOwnFaceAndHands) {
  for (const bool other : {false, true}) {
    TrackingRun run = learned_run();
    track_frame(clip().person[0], run);
    run.state.hands.frames = 100.0;
    FrameFeatures features = extract(clip().person[1], ColourRequest::keep, run.scene);
    features.other_person = other;
    estimate(features, run.tracker, run.state);
    EXPECT_EQ(run.state.phase, Phase::tracking);
    EXPECT_EQ(run.state.hands.frames, other ? 0.0 : 100.0);
  }
}

}  // namespace
}  // namespace telemime
