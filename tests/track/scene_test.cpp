// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracker/scene.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "telemime/core/scratch_folder.h"
#include "track/quick_run.h"

namespace telemime {
namespace {

// A report is what people send to others.
TEST(LearnScene, SaysNoPasswordOfTheBackground) {
  const ScratchFolder folder;
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::create_directories(folder.path() / "http:" / "me:secret@host");
  std::filesystem::current_path(folder.path());
  TrackRequest request;
  request.background = "http://me:secret@host/empty.mp4";
  std::filesystem::copy(TELEMIME_SOURCE_DIR "/data/demo/background.mp4", request.background);
  TrackingRun run = quick_run(quick_config());
  SourceInfo info;
  info.width = 640;
  info.height = 480;
  const std::string learned = learn_scene(request, info, run);
  EXPECT_NE(learned.find("frames of http://host/empty.mp4"), std::string::npos) << learned;
  info.height = 360;
  try {
    learn_scene(request, info, run);
    ADD_FAILURE() << "another aspect ratio";
  } catch (const Error& e) {
    EXPECT_EQ(std::string(e.what()).find("secret"), std::string::npos) << e.what();
  }
  std::filesystem::current_path(before);
}

}  // namespace
}  // namespace telemime
