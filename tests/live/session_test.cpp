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
using live_testing::person_repeated;
using live_testing::quick_request;
using live_testing::ScriptedScene;
using live_testing::SessionEvents;

TEST(LiveSession, EqualsTrackerWithoutDroppedFrames) {
  const ScratchFolder folder;
  const TrackRequest request = quick_request(folder);
  const std::vector<Frame> frames = person_repeated(3);
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

class LiveSessionGuide : public ::testing::Test {
 protected:
  LiveSessionGuide() {
    request_.background.clear();
    scene_->show(empty_room());
  }
  bool reaches(const LiveSession& session, LivePhase phase) {
    return events_.wait([&] { return session.state().phase == phase; });
  }

  ScratchFolder folder_;
  TrackRequest request_ = quick_request(folder_);
  std::shared_ptr<ScriptedScene> scene_ = std::make_shared<ScriptedScene>();
  SessionEvents events_;
};

TEST_F(LiveSessionGuide, LeadsFromEmptySceneToTracking) {
  LiveSession session(request_, true, camera_of(scene_), events_.hooks());
  ASSERT_TRUE(events_.wait([&] { return events_.pictures > 3; }))
      << "images are reported before anything is learned";
  EXPECT_EQ(session.state().phase, LivePhase::empty_room);
  session.guide(GuideStep::empty);
  ASSERT_TRUE(
      events_.wait([&] { return events_.messages.find("the empty room, from") != std::string::npos; }));
  ASSERT_TRUE(reaches(session, LivePhase::person));
  scene_->show(person());
  ASSERT_TRUE(reaches(session, LivePhase::tracking)) << session.state().words;
  EXPECT_EQ(events_.persons, 1);
  session.recalibrate();
  ASSERT_TRUE(events_.wait([&] { return events_.persons == 2; }));
  scene_->show(empty_room());
  ASSERT_TRUE(reaches(session, LivePhase::lost));
  session.guide(GuideStep::again);
  ASSERT_TRUE(reaches(session, LivePhase::empty_room));
  EXPECT_TRUE(session.state().room_empty) << "the image was reported empty the last time";
  session.guide(GuideStep::skip);
  ASSERT_TRUE(reaches(session, LivePhase::person));
  EXPECT_FALSE(session.state().room_empty);
}

TEST_F(LiveSessionGuide, WithoutItTheFirstFramesAreLearned) {
  const LiveSession session(request_, false, camera_of(scene_), events_.hooks());
  EXPECT_TRUE(reaches(session, LivePhase::person));
  EXPECT_NE(events_.messages.find("background: "), std::string::npos);
}

}  // namespace
}  // namespace telemime
