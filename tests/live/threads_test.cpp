// SPDX-License-Identifier: Apache-2.0
// The threads of a session when the camera ends, falls silent or has odd time stamps: quick enough for the
// sanitizers.
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <condition_variable>
#include <limits>
#include <mutex>
#include <stdexcept>
#include <vector>

#include "live/scripted_source.h"
#include "live/session_events.h"
#include "telemime/live/live_session.h"

namespace telemime {
namespace {

using live_testing::camera_of;
using live_testing::person;
using live_testing::person_repeated;
using live_testing::person_scene;
using live_testing::quick_request;
using live_testing::ScriptedScene;
using live_testing::SessionEvents;

class LiveThreads : public ::testing::Test {
 protected:
  bool reaches(const LiveSession& session, LivePhase phase) {
    return events_.wait([&] { return session.state().phase == phase; });
  }

  const ScratchFolder folder_;
  const std::shared_ptr<ScriptedScene> scene_ = person_scene();
  SessionEvents events_;
};

TEST_F(LiveThreads, StopsWhileTheCameraIsSilent) {
  {
    const LiveSession session(quick_request(folder_), true, camera_of(scene_), events_.hooks());
    ASSERT_TRUE(events_.wait([&] { return events_.pictures > 0; }));
    scene_->show({});
    ASSERT_TRUE(reaches(session, LivePhase::stopped));
    scene_->show(person());
    ASSERT_TRUE(reaches(session, LivePhase::tracking)) << "it continues by itself";
    scene_->show({});
  }
}

TEST_F(LiveThreads, ReportsTheEndOfTheCamera) {
  const LiveSession session(quick_request(folder_), true, camera_of(scene_), events_.hooks());
  ASSERT_TRUE(events_.wait([&] { return !events_.motion.empty(); }));
  scene_->end();
  ASSERT_TRUE(reaches(session, LivePhase::ended));
  EXPECT_EQ(session.state().words, "the cable is out");
}

TEST_F(LiveThreads, PhaseIsOpeningUntilFirstFrame) {
  EXPECT_EQ(LiveState().phase, LivePhase::opening) << "before a session exists";
  scene_->show({});
  const LiveSession session(quick_request(folder_), true, camera_of(scene_), events_.hooks());
  EXPECT_EQ(session.state().phase, LivePhase::opening);
  EXPECT_NE(session.state().words, "");
  scene_->show(person());
  ASSERT_TRUE(reaches(session, LivePhase::tracking));
}

// Delivers all its frames and then nothing until it is stopped, like a camera that is gone.
class ThenGone final : public Source {
 public:
  explicit ThenGone(std::vector<Frame> frames) : frames_(std::move(frames)) {
    info_.width = frames_.front().image.cols;
    info_.height = frames_.front().image.rows;
    info_.live = true;
  }
  const SourceInfo& info() const override { return info_; }
  std::string complaint() const override { return ""; }
  void stop() override {
    {
      const std::lock_guard lock(mutex_);
      stopped_ = true;
    }
    changed_.notify_all();
  }
  std::optional<Frame> next() override {
    std::unique_lock lock(mutex_);
    if (at_ == frames_.size()) {
      changed_.wait(lock, [this] { return stopped_; });
    }
    return stopped_ ? std::nullopt : std::optional(frames_[at_++]);
  }

 private:
  std::vector<Frame> frames_;
  std::size_t at_ = 0;
  SourceInfo info_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool stopped_ = false;
};

TEST_F(LiveThreads, FailedSearchWithoutCameraEndsTheRun) {
  std::vector<Frame> frames = person_repeated(4);
  const std::int64_t last = frames.back().index;
  LiveHooks hooks = events_.hooks();
  std::atomic<bool> fail = false;
  std::atomic<bool> failed = false;
  hooks.motion = [&, record_motion = hooks.motion](const MotionFrame& frame, double taken) {
    record_motion(frame, taken);
    if (frame.frame == last) {  // also called when the person is reported lost
      events_.wait([&] { return fail.load(); });
      failed = true;
      throw std::runtime_error("the search has failed");
    }
  };
  const LiveSession session(quick_request(folder_), true, std::make_unique<ThenGone>(std::move(frames)),
                            std::move(hooks));
  // The image side waits for a frame while the search side works on the last one.
  ASSERT_TRUE(reaches(session, LivePhase::stopped));
  fail = true;
  ASSERT_TRUE(reaches(session, LivePhase::ended));
  EXPECT_TRUE(failed);
  EXPECT_EQ(session.state().words, "the search has failed");
}

// The same frames with time stamps of a faulty clock.
class OddStamps final : public Source {
 public:
  explicit OddStamps(std::unique_ptr<Source> camera) : camera_(std::move(camera)) {}
  const SourceInfo& info() const override { return camera_->info(); }
  std::string complaint() const override { return camera_->complaint(); }
  void stop() override { camera_->stop(); }
  std::optional<Frame> next() override {
    auto frame = camera_->next();
    if (frame) {
      constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
      const std::array<double, 6> odd = {0.0, 1.7e9, kNothing, -1e9, 1000.0, 1000.0};
      frame->taken = odd.at(static_cast<std::size_t>(frame->index) % odd.size());
    }
    return frame;
  }

 private:
  std::unique_ptr<Source> camera_;
};

TEST_F(LiveThreads, ToleratesOddTimeStamps) {
  std::atomic<int> looks = 0;
  const Clock clock = {[&looks] { return 1000.0 + 0.001 * looks++; }, [](double) {}};
  LiveSession session(quick_request(folder_), true, std::make_unique<OddStamps>(camera_of(scene_)),
                      events_.hooks(), clock);
  ASSERT_TRUE(events_.wait([&] { return events_.motion.size() > 30; }));
  const LiveRates rates = session.state().rates;
  session.stop();
  double last = 1000.0;
  for (const double taken : events_.taken) {
    EXPECT_GE(taken, last);
    EXPECT_LE(taken, clock.now());
    last = taken;
  }
  EXPECT_GT(rates.tracked, 0.0);
  EXPECT_LE(rates.tracked, 1000.0) << "the clock advances by a millisecond with each reading";
  EXPECT_GE(rates.ms.wait, 0.0);
  EXPECT_GT(rates.ms.total, 0.0);
  EXPECT_LT(rates.ms.total_p95, 1e4);
  EXPECT_EQ(events_.motion.front().state, TrackState::tracking);
}

TEST_F(LiveThreads, MeasuresSilenceByItsOwnClock) {
  std::atomic<double> now = 0.0;
  const LiveSession session(quick_request(folder_), true, camera_of(scene_), events_.hooks(),
                            {[&now] { return now.load(); }, [](double) {}});
  ASSERT_TRUE(events_.wait([&] { return events_.motion.size() > 2; }));
  scene_->show({});
  ASSERT_TRUE(events_.wait([&] {
    now = now + 3.0;
    return session.state().phase == LivePhase::stopped;
  }));
  EXPECT_EQ(session.state().rates.input, 0.0);
}

}  // namespace
}  // namespace telemime
