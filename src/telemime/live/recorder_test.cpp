// SPDX-License-Identifier: Apache-2.0
#include "telemime/live/recorder.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <fstream>
#include <functional>
#include <mutex>
#include <new>
#include <nlohmann/json.hpp>

#include "telemime/core/files.h"
#include "telemime/core/random.h"
#include "telemime/core/scratch_folder.h"
#include "telemime/outputs/gltf/testing_glb.h"
#include "telemime/outputs/readers/jsonl.h"
#include "telemime/outputs/testing_bap.h"
#include "telemime/outputs/testing_bvh.h"
#include "telemime/outputs/testing_motion.h"
#include "telemime/streaming/testing_web.h"

namespace telemime {
namespace {

namespace fs = std::filesystem;

class Records : public ::testing::Test {
 protected:
  std::unique_ptr<Recorder> recorder(std::int64_t most_frames = kMostRecordedFrames,
                                     std::span<const OutputFormat> formats = kOutputFormats,
                                     const OutputOptions& options = {}) {
    return std::make_unique<Recorder>(
        folder_.path() / "r", options,
        [this](MessageLevel level, const std::string& words) {
          const std::lock_guard lock(mutex_);
          (level == MessageLevel::info      ? infos_
           : level == MessageLevel::warning ? warnings_
                                            : errors_) += words + "\n";
        },
        most_frames, formats);
  }
  // A recorder that has begun to record a person.
  std::unique_ptr<Recorder> started(std::int64_t most_frames = kMostRecordedFrames) {
    auto r = recorder(most_frames);
    r->person(header_);
    r->start();
    return r;
  }
  // Stops it and waits until this number of recordings has ended.
  bool stops(Recorder& recorder, std::size_t recordings) {
    recorder.stop();
    return comes_true([&] { return recorder.ended().size() == recordings; });
  }
  std::string errors() {
    const std::lock_guard lock(mutex_);
    return errors_;
  }
  // So many frames, none of which is lost because too many wait.
  void write(Recorder& recorder, std::int64_t count) {
    for (std::int64_t i = 0; i < count; ++i, ++written_) {
      recorder.write(testing_motion::frame_of(header_.body, header_.camera, Pose{}, written_, header_.fps));
      if (written_ % 100 == 99) {
        taken(recorder);
      }
    }
  }
  // Until the recorder's thread has written all frames, or cannot.
  void taken(Recorder& recorder) {
    const auto frames = [&] {
      std::int64_t all = recorder.current() ? recorder.current()->frames : 0;
      for (const Recording& r : recorder.ended()) {
        all += r.frames;
      }
      return all;
    };
    EXPECT_TRUE(comes_true([&] { return frames() > written_ || !errors().empty(); }));
  }
  static nlohmann::json json_of(const fs::path& glb) {
    const std::string bytes = read_text_file(glb);
    EXPECT_EQ(bytes.substr(0, 4), "glTF");
    std::uint32_t length = 0;
    std::copy_n(bytes.begin() + 12, sizeof length, reinterpret_cast<char*>(&length));
    return nlohmann::json::parse(bytes.substr(20, length));
  }
  // Where a node of a GLB file is in its parent.
  static Eigen::Vector3d node_place(const fs::path& file, std::string_view name) {
    const nlohmann::json json = json_of(file);
    for (const nlohmann::json& node : json.at("nodes")) {
      if (node.value("name", "") == name) {
        const std::vector<double> at = node.at("translation");
        return {at.at(0), at.at(1), at.at(2)};
      }
    }
    ADD_FAILURE() << "no node " << name;
    return Eigen::Vector3d::Zero();
  }
  // How many keys the animation in a GLB file has.
  static std::size_t keys(const fs::path& file) {
    const nlohmann::json json = json_of(file);
    const std::size_t input = json.at("animations").at(0).at("samplers").at(0).at("input");
    return json.at("accessors").at(input).at("count");
  }

  ScratchFolder folder_;
  StreamHeader header_ = testing_motion::header();
  std::int64_t written_ = 0;
  std::mutex mutex_;
  std::string infos_;
  std::string warnings_;
  std::string errors_;
};

TEST_F(Records, EveryFormatFromStartToStop) {
  const auto r = started();
  write(*r, 50);
  ASSERT_TRUE(stops(*r, 1));
  const Recording recording = r->ended().front();
  EXPECT_EQ(recording.frames, 50);
  EXPECT_EQ(recording.files.size(), kOutputFormats.size());
  EXPECT_EQ(read_pose_jsonl(recording.folder / "pose.jsonl").frames.size(), 50U);
  EXPECT_EQ(keys(recording.folder / "motion.glb"), 50U);
  EXPECT_EQ(r->file(1, "motion.bvh"), recording.folder / "motion.bvh");
  EXPECT_EQ(r->file(2, "motion.bvh"), std::nullopt);
  EXPECT_EQ(r->file(1, "../../x"), std::nullopt);
  EXPECT_TRUE(r->forget(1));
  EXPECT_FALSE(r->forget(1));
  EXPECT_TRUE(comes_true([&] { return !fs::exists(recording.folder); }));
  EXPECT_EQ(errors(), "");
}

// The palm is learned while the person is tracked: from the start of a recording, and until its end.
TEST_F(Records, FingersAreAsLongAsLearnedUnlessLeftOut) {
  header_.fingers = true;
  for (const bool fingers : {true, false}) {
    const auto r = recorder(kMostRecordedFrames, kOutputFormats, {.fingers = fingers});
    r->person(header_);
    r->start();
    HandMotions hands;
    for (std::int64_t i = 0; i < 5; ++i) {
      MotionFrame frame = testing_motion::frame_of(header_.body, header_.camera, Pose{}, i, header_.fps);
      for (HandMotion& hand : hands) {
        hand.sizes.palm = 0.1 + 0.002 * static_cast<double>(i);
      }
      frame.hands = hands;
      r->write(frame);
    }
    ASSERT_TRUE(stops(*r, 1));
    const fs::path folder = r->ended().front().folder;
    const auto bvh = testing_bvh::parse_bvh(read_text_file(folder / "motion.bvh"));
    const auto finger = std::find_if(bvh.joints.begin(), bvh.joints.end(), [](const BvhJoint& joint) {
      return joint.name == motion_builder_name(finger_bone(Side::left, 2, 0));
    });
    ASSERT_EQ(finger != bvh.joints.end(), fingers);
    for (const char* const name : {"motion.glb", "motion.vrma"}) {
      const std::string text = read_text_file(folder / name);
      EXPECT_EQ(text.find(kFingerBoneNames[0]) != std::string::npos, fingers) << name;
    }
    if (fingers) {
      const FingerSkeleton learned = finger_skeleton(hands);
      const std::size_t bone = finger_bone(Side::left, 2, 0);
      EXPECT_LT((finger->offset - 100.0 * learned.offset(bone)).norm(), 1e-3);
      for (const char* const name : {"motion.glb", "motion.vrma"}) {
        EXPECT_LT((node_place(folder / name, kFingerBoneNames[bone]) - learned.offset(bone)).norm(), 1e-5);
      }
    }
  }
}

TEST_F(Records, OneThatIsFullGoesOnInTheNext) {
  const auto r = started(40);
  write(*r, 100);
  ASSERT_TRUE(stops(*r, 3));
  EXPECT_EQ(r->ended()[0].frames, 40);
  EXPECT_EQ(r->ended()[1].frames, 40);
  EXPECT_EQ(r->ended()[2].frames, 20);
  const std::lock_guard lock(mutex_);
  EXPECT_NE(infos_.find("recording 1 is full"), std::string::npos) << infos_;
  EXPECT_EQ(warnings_ + errors_, "");
}

TEST_F(Records, DurationsAgreeForAnyTimes) {
  const auto r = started();
  Random random(5);
  double time = 0.0;
  for (int i = 0; i < 60; ++i) {
    MotionFrame frame = testing_motion::frame_of(header_.body, header_.camera, Pose{}, i, header_.fps);
    frame.time = 7.0 + time;
    r->write(frame);
    time += i == 59 ? 0.0 : 0.001 + 2.0 / header_.fps * random.uniform() + (i == 30 ? 6.0 : 0.0);
  }
  ASSERT_TRUE(stops(*r, 1));
  const Recording recording = r->ended().front();
  const double step = 1.0 / header_.fps + 0.002;
  const auto lasts = [&](std::size_t frames) { return static_cast<double>(frames - 1) / header_.fps; };
  const auto text = [&](const char* name) { return read_text_file(recording.folder / name); };
  EXPECT_NEAR(recording.seconds, time, 2.0 * step);
  EXPECT_NEAR(lasts(testing_bvh::parse_bvh(text("motion.bvh")).frames.size()), time, step);
  EXPECT_NEAR(lasts(testing_bap::parse_bap(text("motion.bap")).frames.size()), time, step);
  for (const char* name : {"motion.glb", "motion.vrma"}) {
    const testing_glb::Glb glb = testing_glb::parse(text(name));
    const std::size_t input = glb.json["animations"][0]["samplers"][0]["input"];
    EXPECT_NEAR(testing_glb::numbers<float>(glb, input).back(), time, step) << name;
  }
  const auto last_time = [&](const char* table) {
    const std::string rows = text(table);
    const std::string last = rows.substr(rows.rfind('\n', rows.size() - 2) + 1);
    return std::stod(last.substr(last.find_first_of(",\t") + 1));
  };
  EXPECT_NEAR(last_time("motion.trc"), time, step);
  // Files with times have the frames and times of the tracker, so that they can be compared with a truth.
  EXPECT_NEAR(last_time("pose.csv"), 7.0 + time, 1e-5);
  const PoseFile poses = read_pose_jsonl(recording.folder / "pose.jsonl");
  ASSERT_EQ(poses.frames.size(), 60U);
  EXPECT_EQ(poses.frames.back().frame, 59);
  EXPECT_NEAR(poses.frames.front().time, 7.0, 1e-5);
  EXPECT_NEAR(poses.frames.back().time, 7.0 + time, 1e-5);
}

TEST_F(Records, AfterALongGapItGoesOnInTheNext) {
  const auto r = started();
  for (const double time : {0.0, 8.0, 100'000.0, 100'000.04}) {
    const auto index = static_cast<std::int64_t>(std::lround(time * header_.fps));
    r->write(testing_motion::frame_of(header_.body, header_.camera, Pose{}, index, header_.fps));
  }
  r->stop();
  ASSERT_TRUE(comes_true([&] { return r->ended().size() == 2 || !errors().empty(); }));
  EXPECT_EQ(errors(), "");
  EXPECT_EQ(r->ended()[0].frames, 201) << "a gap of some seconds is filled";
  EXPECT_EQ(r->ended()[1].frames, 2);
  const std::lock_guard lock(mutex_);
  EXPECT_NE(warnings_.find("no frames for 99992 s: recording 1 ends here"), std::string::npos) << warnings_;
}

TEST_F(Records, AnotherBodyGoesOnInTheNext) {
  const auto r = started();
  write(*r, 20);
  r->person(header_);
  write(*r, 10);
  ASSERT_TRUE(stops(*r, 2));
  EXPECT_EQ(r->ended()[0].frames, 20);
  EXPECT_EQ(r->ended()[1].frames, 10);
  const std::lock_guard lock(mutex_);
  EXPECT_NE(infos_.find("recalibrated: recording 1 ends here"), std::string::npos) << infos_;
  EXPECT_EQ(infos_.find("recording 2 ends here"), std::string::npos) << infos_;
}

// As the session reports a person who is lost at the end of the input.
TEST_F(Records, AFrameThatComesAgainIsWrittenOnce) {
  const auto r = started();
  write(*r, 5);
  MotionFrame again = testing_motion::frame_of(header_.body, header_.camera, Pose{}, 4, header_.fps);
  again.state = TrackState::lost;
  r->write(again);
  ASSERT_TRUE(stops(*r, 1));
  const Recording recording = r->ended().front();
  EXPECT_EQ(read_pose_jsonl(recording.folder / "pose.jsonl").frames.size(), 5U);
  EXPECT_EQ(errors(), "");
}

// A format whose tail needs more memory than there is.
class NoEnd final : public Encoder {
 public:
  std::string begin(const StreamHeader& /*header*/) override { return "head\n"; }
  std::string frame(const MotionFrame& /*frame*/) override { return "frame\n"; }
  std::string end() override { throw std::bad_alloc(); }
};

TEST_F(Records, WhatFailsAtTheEndIsToldAndTheOtherFilesAreWhole) {
  const std::array<OutputFormat, 2> formats = {
      {{"odd", "motion.odd", "",
        [](const OutputOptions&) -> std::unique_ptr<Encoder> { return std::make_unique<NoEnd>(); }},
       output_format("glb")}};
  const auto r = recorder(kMostRecordedFrames, formats);
  r->person(header_);
  for (std::size_t time = 1; time <= 2; ++time) {
    r->start();
    write(*r, 5);
    ASSERT_TRUE(stops(*r, time));
    EXPECT_FALSE(r->current());
    const Recording recording = r->ended().back();
    EXPECT_EQ(recording.files.size(), 2U);
    EXPECT_EQ(keys(recording.folder / "motion.glb"), 5U);
    EXPECT_EQ(read_text_file(recording.folder / "motion.odd").substr(0, 11), "head\nframe\n");
  }
  EXPECT_NE(errors().find("motion.odd is incomplete"), std::string::npos) << errors();
}

TEST_F(Records, FoldersOfOthersAreLeftAlone) {
  fs::create_directories(folder_.path() / "r" / "recording-1");
  std::ofstream(folder_.path() / "r" / "recording-2") << "a file";
  const auto r = started();
  write(*r, 2);
  ASSERT_TRUE(stops(*r, 1));
  EXPECT_EQ(r->ended().front().folder.filename(), "recording-3");
  EXPECT_EQ(r->ended().front().number, 3);
  EXPECT_TRUE(fs::is_empty(folder_.path() / "r" / "recording-1"));
}

TEST_F(Records, AFolderThatCannotBeUsedIsAnError) {
  const fs::path folder = folder_.path() / "r";
  const std::function<void()> obstacles[] = {
      [&] { std::ofstream(folder) << "a file"; },
      // As behind a folder that may not be entered: even its existence is unknown.
      [&] { fs::create_symlink(folder, folder); }};
  for (const auto& make_obstacle : obstacles) {
    errors_.clear();
    fs::remove(folder);
    make_obstacle();
    const auto r = started();
    write(*r, 1);
    ASSERT_TRUE(comes_true([&] { return !errors().empty(); }));
    EXPECT_NE(errors().find("--recordings"), std::string::npos) << errors();
    EXPECT_FALSE(r->current());
  }
}

// A limit to the size of files stands for the full disk: the system refuses to write in the same way.
TEST_F(Records, AFullDiskIsAnErrorInWordsAndWhatWasWrittenIsKept) {
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const auto r = recorder();
  r->person(header_);
  const rlimit small{300'000, before.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  r->start();
  for (int i = 0; i < 2000 && errors().empty(); ++i) {
    write(*r, 1);
  }
  const bool ended = comes_true([&] { return r->ended().size() == 1; });
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  ASSERT_TRUE(ended);

  EXPECT_NE(errors().find("the recording was stopped: cannot write"), std::string::npos) << errors();
  EXPECT_NE(errors().find("pose.jsonl"), std::string::npos) << errors();
  EXPECT_FALSE(r->current());
  const Recording recording = r->ended().front();
  const PoseFile poses = read_pose_jsonl(recording.folder / "pose.jsonl");
  EXPECT_GT(poses.frames.size(), 50U);
  EXPECT_EQ(poses.complaint, "") << "no half line is left";
  EXPECT_GE(keys(recording.folder / "motion.glb"), poses.frames.size());
  EXPECT_GE(keys(recording.folder / "motion.vrma"), poses.frames.size());
  EXPECT_EQ(recording.files.size(), kOutputFormats.size());

  r->start();  // there is room again
  write(*r, 30);
  ASSERT_TRUE(stops(*r, 2));
  EXPECT_GT(r->ended()[1].frames, 0);
}

}  // namespace
}  // namespace telemime
