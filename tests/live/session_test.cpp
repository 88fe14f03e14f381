// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "live/scripted_source.h"
#include "live/session_events.h"
#include "support/list_source.h"
#include "telemime/live/live_session.h"
#include "telemime/tracker/set_up.h"
#include "telemime/tracker/smoother.h"
#include "telemime/tracker/track_frame.h"

namespace telemime {
namespace {

using live_testing::camera_of;
using live_testing::empty_room;
using live_testing::person;
using live_testing::quick_request;
using live_testing::ScriptedScene;
using live_testing::SessionEvents;

std::vector<Frame> several_times(int times) {
  std::vector<Frame> frames;
  for (int i = 0; i < times; ++i) {
    frames.insert(frames.end(), person().begin(), person().end());
  }
  for (std::size_t i = 0; i < frames.size(); ++i) {
    frames[i].index = static_cast<std::int64_t>(i);
    frames[i].time = static_cast<double>(i) / 25.0;
  }
  return frames;
}

TEST(LiveSession, EqualsTrackerWithoutDroppedFrames) {
  const ScratchFolder folder;
  const TrackRequest request = quick_request(folder);
  const std::vector<Frame> frames = several_times(3);
  SessionEvents events;
  {
    LiveSession session(request, true, std::make_unique<support::ListSource>(frames), events.hooks());
    ASSERT_TRUE(events.wait([&] { return session.state().phase == LivePhase::ended; }));
  }
  const support::ListSource source(frames);
  std::vector<std::string> messages;
  TrackingRun run = open_run(request, source.info(), messages);
  run.scene.features.learn_background(empty_room());
  std::unique_ptr<Smoother> smoother;
  std::vector<MotionFrame> expected;
  for (const Frame& frame : frames) {
    const FrameEstimate result = track_frame(frame, run).estimate;
    if (run.state.calibrated() && !smoother) {
      smoother = make_smoother(request.config.smoothing, run.state.model.body, run.tracker.camera);
    }
    if (smoother) {
      expected.push_back((*smoother)(result.motion));
    }
  }
  ASSERT_GT(expected.size(), 10U);
  ASSERT_EQ(events.motion.size(), expected.size() + 1);
  EXPECT_EQ(events.motion.back().state, TrackState::lost) << "at the end the person is lost";
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(events.motion[i].frame, expected[i].frame);
    EXPECT_EQ(events.motion[i].state, expected[i].state);
    EXPECT_EQ(events.motion[i].pose.vector(), expected[i].pose.vector()) << i;
  }
  EXPECT_EQ(events.persons, 1);
  EXPECT_EQ(events.pictures, static_cast<int>(frames.size()));
}

TEST(LiveSession, GuidesFromEmptySceneToTracking) {
  const ScratchFolder folder;
  TrackRequest request = quick_request(folder);
  request.background.clear();
  const auto scene = std::make_shared<ScriptedScene>();
  scene->show(empty_room());
  SessionEvents events;
  LiveSession session(request, true, camera_of(scene), events.hooks());
  ASSERT_TRUE(events.wait([&] { return events.pictures > 3; }))
      << "images are reported before anything is learned";
  EXPECT_EQ(session.state().phase, LivePhase::empty_room);
  session.guide(GuideStep::empty);
  ASSERT_TRUE(events.wait([&] { return events.messages.find("the empty room, from") != std::string::npos; }));
  ASSERT_TRUE(events.wait([&] { return session.state().phase == LivePhase::person; }));
  scene->show(person());
  ASSERT_TRUE(events.wait([&] { return session.state().phase == LivePhase::tracking; }))
      << session.state().words;
  EXPECT_EQ(events.persons, 1);
  session.recalibrate();
  ASSERT_TRUE(events.wait([&] { return events.persons == 2; }));
  scene->show(empty_room());
  ASSERT_TRUE(events.wait([&] { return session.state().phase == LivePhase::lost; }));
  session.guide(GuideStep::again);
  ASSERT_TRUE(events.wait([&] { return session.state().phase == LivePhase::empty_room; }));
  EXPECT_TRUE(session.state().room_empty) << "the image was reported empty the last time";
  session.guide(GuideStep::skip);
  ASSERT_TRUE(events.wait([&] { return session.state().phase == LivePhase::person; }));
  EXPECT_FALSE(session.state().room_empty);
}

TEST(LiveSession, LearnsFromFirstFramesWithoutGuide) {
  const ScratchFolder folder;
  TrackRequest request = quick_request(folder);
  request.background.clear();
  const auto scene = std::make_shared<ScriptedScene>();
  scene->show(empty_room());
  SessionEvents events;
  const LiveSession session(request, false, camera_of(scene), events.hooks());
  EXPECT_TRUE(events.wait([&] { return session.state().phase == LivePhase::person; }));
  EXPECT_NE(events.messages.find("background: "), std::string::npos);
}

}  // namespace
}  // namespace telemime
