// SPDX-License-Identifier: Apache-2.0
// The same clip as a file and in place of a camera.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <iostream>
#include <memory>
#include <vector>

#include "live/session_events.h"
#include "support/needs.h"
#include "telemime/capture/playback.h"
#include "telemime/core/scratch_folder.h"
#include "telemime/offline/track_file.h"
#include "telemime/outputs/all.h"
#include "telemime/outputs/readers/jsonl.h"

namespace telemime {
namespace {

constexpr std::int64_t kFrames = 20;

// The first frames of a file.
class FirstFrames final : public Source {
 public:
  explicit FirstFrames(std::unique_ptr<Source> file, std::int64_t count = kFrames)
      : file_(std::move(file)), left_(count) {}
  const SourceInfo& info() const override { return file_->info(); }
  std::string complaint() const override { return file_->complaint(); }
  std::optional<Frame> next() override { return left_-- > 0 ? file_->next() : std::nullopt; }

 private:
  std::unique_ptr<Source> file_;
  std::int64_t left_;
};

// A clock that jumps to any time that is waited for: no tracker is late, and no frame is dropped.
Clock patient_clock() {
  const auto now = std::make_shared<std::atomic<double>>(50.0);
  return {[now] { return now->load(); }, [now](double time) { now->store(time); }};
}

// Equal conditions: the same background, no look-ahead, no future frames in the smoothing.
TrackRequest demo() {
  TrackRequest request;
  const std::filesystem::path folder = TELEMIME_SOURCE_DIR "/data/demo";
  request.input = (folder / "video.mp4").string();
  request.background = (folder / "background.mp4").string();
  request.overlay = false;
  request.formats = {"jsonl"};
  request.most_frames = kFrames;
  request.config.image.width = 160;
  request.config.image.height = 120;
  request.config.filter.particles = 300;
  request.config.calibration.look_ahead = 0;
  request.config.smoothing.look_ahead = 0;
  return request;
}

TEST(LiveAndFile, PacedFileGivesPosesOfFileMode) {
  const ScratchFolder folder;
  TrackRequest request = demo();
  request.config.smoothing.name = "none";
  request.config.look_back = false;
  request.out = folder.file("out");
  std::vector<MotionFrame> file;
  RunHooks hooks;
  hooks.progress = [&](const Progress& progress) {
    file.push_back(*progress.motion);
    return ViewerRequest::none;
  };
  track_file(request, hooks);

  live_testing::SessionEvents events;
  std::int64_t dropped = -1;
  {
    LiveSession session(request, false,
                        pace(std::make_unique<FirstFrames>(open_source(request.input)), patient_clock()),
                        events.hooks());
    ASSERT_TRUE(events.wait([&] { return session.state().phase == LivePhase::ended; }));
    dropped = session.state().rates.dropped;
  }
  ASSERT_EQ(dropped, 0);
  ASSERT_EQ(file.size(), static_cast<std::size_t>(kFrames));
  ASSERT_GT(events.motion.size(), 10U);
  events.motion.pop_back();  // at the end the person is lost
  int tracked = 0;
  for (const MotionFrame& live : events.motion) {
    const MotionFrame& same = file.at(static_cast<std::size_t>(live.frame));
    EXPECT_EQ(live.state, same.state) << live.frame;
    EXPECT_EQ(live.pose.vector(), same.pose.vector()) << live.frame;
    EXPECT_EQ(live.pixels, same.pixels) << live.frame;
    tracked += live.state == TrackState::tracking ? 1 : 0;
  }
  EXPECT_GT(tracked, 10);
  for (std::int64_t frame = 0; frame < events.motion.front().frame; ++frame) {
    EXPECT_EQ(file.at(static_cast<std::size_t>(frame)).state, TrackState::lost)
        << "before a person is calibrated";
  }
}

TEST(LiveAndFile, FilesAreEqualWithSameSmoothing) {
  const ScratchFolder folder;
  TrackRequest request = demo();
  request.config.look_back = false;
  request.out = folder.file("out");
  track_file(request, {});
  const PoseFile file = read_pose_jsonl(request.out / "pose.jsonl");

  live_testing::SessionEvents events;
  StreamHeader header;
  LiveHooks hooks = events.hooks();
  hooks.person = [&](const StreamHeader& person) { header = person; };
  {
    LiveSession session(request, false,
                        pace(std::make_unique<FirstFrames>(open_source(request.input)), patient_clock()),
                        hooks);
    ASSERT_TRUE(events.wait([&] { return session.state().phase == LivePhase::ended; }));
  }
  events.motion.pop_back();
  const auto* const format = std::find_if(kOutputFormats.begin(), kOutputFormats.end(),
                                          [](const OutputFormat& f) { return f.name == "jsonl"; });
  ASSERT_NE(format, kOutputFormats.end());
  const auto encoder = format->make({});
  std::string text = encoder->begin(header);
  for (const MotionFrame& motion : events.motion) {
    text += encoder->frame(motion);
  }
  const PoseFile live = parse_pose_jsonl(text + encoder->end(), "live");
  ASSERT_GT(live.frames.size(), 10U);
  EXPECT_EQ(live.shape.stature, file.shape.stature);
  for (const MotionFrame& motion : live.frames) {
    const MotionFrame& same = file.frames.at(static_cast<std::size_t>(motion.frame));
    EXPECT_EQ(motion.state, same.state) << motion.frame;
    EXPECT_EQ(motion.pose.vector(), same.pose.vector()) << motion.frame;
  }
}

class LiveWithoutGuide : public support::WithNetworks {};

// The default of `telemime live`: a room as it is, nobody steps out of the picture, no guide.
TEST_F(LiveWithoutGuide, TheAvatarMovesWithinThreeSeconds) {
  std::vector<std::filesystem::path> clips = {TELEMIME_SOURCE_DIR "/data/demo/video.mp4"};
  const std::filesystem::path data = support::test_data();
  for (const char* other : {"dev_practical/desk_talk/video.mp4", "real/webcam_hello/clip.mp4"}) {
    if (std::filesystem::exists(data / other)) {
      clips.push_back(data / other);
    } else {
      std::cout << "not tested, because it is not there: " << other << '\n';
    }
  }
  for (const std::filesystem::path& clip : clips) {
    SCOPED_TRACE(clip.string());
    constexpr double kSoon = 3.0;  // s
    TrackRequest request = demo();
    request.input = clip.string();
    request.background.clear();
    request.config.image.models = TELEMIME_BUILD_MODELS;
    ASSERT_TRUE(uses_networks(request.config));
    std::unique_ptr<Source> file = open_source(request.input);
    const auto frames = static_cast<std::int64_t>(kSoon * file->info().fps);
    live_testing::SessionEvents events;
    {
      LiveSession session(request, false,
                          pace(std::make_unique<FirstFrames>(std::move(file), frames), patient_clock()),
                          events.hooks());
      ASSERT_TRUE(events.wait([&] { return session.state().phase == LivePhase::ended; }));
    }
    EXPECT_EQ(events.persons, 1) << events.messages;
    const auto moves = std::count_if(events.motion.begin(), events.motion.end(),
                                     [](const MotionFrame& m) { return m.state == TrackState::tracking; });
    EXPECT_GT(moves, frames / 3) << "at least a second of the first three";
  }
}

}  // namespace
}  // namespace telemime
