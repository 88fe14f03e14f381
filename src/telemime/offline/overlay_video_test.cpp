// SPDX-License-Identifier: Apache-2.0
#include "telemime/offline/overlay_video.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "telemime/capture/prepare_opencv.h"
#include "telemime/capture/source.h"
#include "telemime/core/scratch_folder.h"

namespace telemime {
namespace {

struct Written {
  std::vector<std::string> notes;
  double last = 0.0;  ///< time of the last picture in the file, s
  int pictures = 0;
};

Written write(const std::filesystem::path& folder, double fps, const std::vector<double>& times) {
  Written written;
  OverlayVideo video(folder, fps, [&](const std::string& note) { written.notes.push_back(note); });
  for (const double time : times) {
    video.write(cv::Mat(64, 96, CV_8UC3, cv::Scalar::all(90)), time);
  }
  video.close();
  if (!video.file().empty()) {
    const auto source = open_source(video.file());
    while (const std::optional<Frame> frame = source->next()) {
      written.last = frame->time;
      ++written.pictures;
    }
  }
  return written;
}

TEST(OverlayVideo, LastsAsLongAsItsFramesAtAnyRate) {
  prepare_opencv();
  const ScratchFolder scratch;
  const auto folder = std::filesystem::path(scratch.file("2026-11-25T10:30:45+00:00 %d"));
  std::filesystem::create_directory(folder);
  for (const double fps : {5.0, 19.24, 24000.0 / 1001.0, 29.97, 60.0, 119.881, 240.0, 1000.0}) {
    std::vector<double> times;
    for (int i = 0; i < 60; ++i) {
      times.push_back(2.0 + i / fps + (i > 40 ? 3.0 : 0.0));
    }
    const Written written = write(folder, fps, times);
    EXPECT_TRUE(written.notes.empty()) << written.notes[0];
    EXPECT_NEAR(written.last, times.back() - times.front(), 1.0 / overlay_rate(fps) + 2e-3) << fps;
    EXPECT_TRUE(std::filesystem::exists(folder / "overlay.png"));
  }
}

TEST(OverlayVideo, ItsRateIsFiniteAtAnyRate) {
  for (const double fps : {0.001, 0.05, 0.06, 1.0, 25.0, 60.0, 119.881, 1000.0}) {
    const double rate = overlay_rate(fps);
    EXPECT_GT(rate, 0.0) << fps;
    EXPECT_LE(rate, std::min(fps, 60.1)) << fps;
  }
}

TEST(OverlayVideo, WhatFailsIsANote) {
  const ScratchFolder scratch;
  const Written nowhere = write(scratch.file("absent"), 25.0, {0.0, 0.04});
  EXPECT_EQ(nowhere.notes.size(), 1U);
  EXPECT_EQ(nowhere.pictures, 0);
  std::filesystem::create_directories(scratch.file("overlay.mp4"));
  EXPECT_EQ(write(scratch.file(""), 25.0, {0.0, 0.04}).notes.size(), 1U) << "a folder has its name";
  if (std::filesystem::exists("/dev/full")) {
    std::filesystem::create_directories(scratch.file("full"));
    std::filesystem::create_symlink("/dev/full", scratch.file("full/overlay.mp4"));
    EXPECT_EQ(write(scratch.file("full"), 25.0, {0.0, 0.04}).notes.size(), 1U) << "the disk is full";
  }
}

}  // namespace
}  // namespace telemime
