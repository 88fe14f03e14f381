// SPDX-License-Identifier: Apache-2.0
#include "telemime/offline/run_outputs.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <sstream>

#include "telemime/core/errors.h"
#include "telemime/core/scratch_folder.h"
#include "telemime/outputs/gltf/testing_glb.h"
#include "telemime/outputs/readers/jsonl.h"
#include "telemime/outputs/testing_bap.h"
#include "telemime/outputs/testing_bvh.h"
#include "telemime/outputs/testing_motion.h"

namespace telemime {
namespace {

std::string text_of(const std::string& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

// Time from the first to the last line of a TRC file, s.
double last_time_of_trc(const std::string& text) {
  std::istringstream lines(text);
  std::string line;
  std::string last;
  while (std::getline(lines, line)) {
    last = line.empty() ? last : line;
  }
  return std::stod(last.substr(last.find('\t') + 1));
}

// Whatever the times, all files last equally long.
TEST(RunOutputs, DurationsAgreeForAnyTimes) {
  Random random(11);
  for (const double fps : {7.5, 25.0, 59.94}) {
    for (const double pause : {0.0, 15.0}) {
      const ScratchFolder scratch;
      TrackRequest request;
      request.out = scratch.file("out:1");
      StreamHeader header = testing_motion::header();
      header.fps = fps;
      RunOutputs outputs(request, fps, nullptr);
      outputs.begin(header);
      double time = 0.0;
      for (int i = 0; i < 60; ++i) {
        MotionFrame frame = testing_motion::frame_of(header.body, header.camera, Pose(), i, fps);
        frame.time = time;
        outputs.write(frame);
        outputs.write_overlay(cv::Mat(48, 64, CV_8UC3, cv::Scalar::all(80)), time);
        time += i == 59 ? 0.0 : 0.001 + 2.0 / fps * random.uniform() + (i == 30 ? pause : 0.0);
      }
      outputs.close_overlay();
      outputs.close({});
      const auto text = [&](const char* name) { return text_of(scratch.file(std::string("out:1/") + name)); };
      const double step = 1.0 / fps + 0.002;
      const auto video = open_source(scratch.file("out:1/overlay.mp4"));
      double shown = 0.0;
      while (const std::optional<Frame> frame = video->next()) {
        shown = frame->time;
      }
      EXPECT_NEAR(shown, time, step) << fps;
      EXPECT_NEAR(last_time_of_trc(text("motion.trc")), time, step) << fps;
      const testing_bvh::BvhFile bvh = testing_bvh::parse_bvh(text("motion.bvh"));
      EXPECT_NE(text("motion.bvh").find("Frames: " + std::to_string(bvh.frames.size())), std::string::npos);
      EXPECT_NEAR(static_cast<double>(bvh.frames.size() - 1) * bvh.frame_time, time, step) << fps;
      const testing_bap::BapFile bap = testing_bap::parse_bap(text("motion.bap"));
      EXPECT_NEAR(static_cast<double>(bap.frames.size() - 1) / bap.fps, time, step) << fps;
      for (const char* name : {"motion.glb", "motion.vrma"}) {
        const testing_glb::Glb glb = testing_glb::parse(text(name));
        for (const auto& sampler : glb.json["animations"][0]["samplers"]) {
          EXPECT_NEAR(testing_glb::numbers<float>(glb, sampler["input"]).back(), time, step) << name << fps;
        }
      }
      const std::string table = text("pose.csv");
      const std::string row = table.substr(table.rfind('\n', table.size() - 2) + 1);
      EXPECT_NEAR(std::stod(row.substr(row.find(',') + 1)), time, 1e-5);
      const PoseFile poses = parse_pose_jsonl(text("pose.jsonl"), "pose.jsonl");
      EXPECT_EQ(poses.frames.size(), 60U) << "the true ones";
      EXPECT_NEAR(poses.frames.back().time, time, 1e-5);
    }
  }
}

// A run that goes on with another person, at a time between those of the files of constant rate.
TEST(RunOutputs, FramesBetweenHaveTheBonesOfTheirPerson) {
  const ScratchFolder scratch;
  TrackRequest request;
  request.out = scratch.path();
  request.overlay = false;
  request.formats = {"trc"};
  const StreamHeader header = testing_motion::header();
  Shape tall;
  tall.stature = 2.0;
  RunOutputs outputs(request, header.fps, nullptr);
  outputs.begin(header);
  const auto write = [&](const Body& body, int first, int last) {
    for (int i = first; i < last; ++i) {
      MotionFrame frame = testing_motion::frame_of(body, header.camera, Pose(), i, header.fps);
      frame.time += 0.4 / header.fps * (i % 2);
      outputs.write(frame);
    }
  };
  write(header.body, 0, 20);
  outputs.set_body(make_body(tall));
  write(make_body(tall), 20, 40);
  outputs.close({});
  // All frames of a person have the second marker at the same height above the root.
  std::istringstream lines(text_of(scratch.file("motion.trc")));
  std::vector<double> heights;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream cells(line);
    std::vector<double> row;
    for (double cell = 0.0; cells >> cell;) {
      row.push_back(cell);
    }
    if (row.size() > 12) {
      heights.push_back(row[6] - row[3]);
    }
  }
  ASSERT_GE(heights.size(), 39U);
  for (std::size_t i = 22; i < heights.size(); ++i) {
    EXPECT_NEAR(heights[i], heights.back(), 0.1) << i;
  }
  EXPECT_GT(heights.back(), 1.1 * heights.front());
}

TEST(RunOutputs, NeverReplaceWhatTheRunReads) {
  const ScratchFolder folder;
  TrackRequest request;
  request.out = folder.path();
  for (std::string* read : {&request.input, &request.background, &request.camera, &request.calibration}) {
    for (const char* name : {"overlay.mp4", "overlay.png", "report.json", "pose.jsonl"}) {
      const std::string file = folder.file(name);
      std::ofstream(file) << "precious";
      for (const std::string& spelled : {file, "file://" + file, (folder.path() / "." / name).string()}) {
        *read = spelled;
        EXPECT_THROW(RunOutputs(request, 25.0, nullptr), Error) << spelled;
        EXPECT_THROW(prepare_file(file, request), Error) << spelled;
        EXPECT_EQ(text_of(file), "precious");
      }
      std::filesystem::remove(file);
      EXPECT_NO_THROW(prepare_file(file, request)) << "nothing is there yet";
    }
    read->clear();
  }
}

TEST(RunOutputs, NeverLieAmongTheImagesThatAreRead) {
  const ScratchFolder folder;
  std::ofstream(folder.file("1.png")) << "an image";
  TrackRequest request;
  request.out = folder.path();
  request.input = folder.path().string();
  EXPECT_THROW(prepare_outputs(request), Error) << "overlay.png would be an image of the next run";
  request.overlay = false;
  EXPECT_NO_THROW(prepare_outputs(request));
  request.overlay = true;
  request.input = folder.file("*.png");
  EXPECT_NO_THROW(prepare_outputs(request));
  std::ofstream(folder.file("overlay.png")) << "an image";
  EXPECT_THROW(prepare_outputs(request), Error);
  request.out = folder.path() / "results";
  EXPECT_NO_THROW(prepare_outputs(request));
}

TEST(RunOutputs, WithoutAFolderNothingIsWritten) {
  TrackRequest request;
  RunOutputs outputs(request, 25.0, nullptr);
  const StreamHeader header = testing_motion::header();
  outputs.begin(header);
  outputs.write(testing_motion::frame_of(header.body, header.camera, Pose(), 0, 25.0));
  EXPECT_FALSE(outputs.has_overlay());
  EXPECT_TRUE(outputs.files().empty());
  outputs.close({});
  EXPECT_FALSE(std::filesystem::exists("report.json"));
}

TEST(RunOutputs, BegunAgainHaveNoReport) {
  const ScratchFolder folder;
  TrackRequest request;
  request.out = folder.path();
  request.overlay = false;
  RunOutputs first(request, 25.0, nullptr);
  first.begin(testing_motion::header());
  first.close({});
  ASSERT_TRUE(std::filesystem::exists(folder.path() / "report.json"));
  const RunOutputs again(request, 25.0, nullptr);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "report.json")) << "of files that are replaced";
}

}  // namespace
}  // namespace telemime
