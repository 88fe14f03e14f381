// SPDX-License-Identifier: Apache-2.0
#include "telemime/capture/cameras.h"

#include <gtest/gtest.h>

#include <fstream>
#include <stdexcept>

#include "telemime/core/errors.h"
#include "telemime/core/scratch_folder.h"

namespace telemime {
namespace {

namespace fs = std::filesystem;

// A computer with a laptop's camera (images, metadata, infrared, its metadata), a camera at USB and a codec.
std::vector<CameraInfo> computer() {
  const std::vector<CameraMode> webcam = {{"YUYV", 640, 480, 30.0},
                                          {"YUYV", 1280, 720, 10.0},
                                          {"MJPG", 640, 480, 30.0},
                                          {"MJPG", 1280, 720, 30.0}};
  return {{"/dev/video0", "HP Wide Vision: HP IR", "", CameraKind::camera, {{"GREY", 640, 360, 15.0}}, ""},
          {"/dev/video1", "HP Wide Vision: HP HD", "", CameraKind::metadata, {}, ""},
          {"/dev/video2", "HP Wide Vision: HP HD", "", CameraKind::camera, webcam, ""},
          {"/dev/video4", "HD Pro Webcam C920", "/dev/v4l/by-id/usb-046d_C920_ABC-video-index0",
           CameraKind::camera, webcam, ""},
          {"/dev/video10", "codec", "", CameraKind::no_camera, {}, ""}};
}

TEST(Cameras, AreListedByNumberWithTheirNames) {
  const ScratchFolder scratch;
  const fs::path root = scratch.path();
  fs::create_directories(root / "dev/v4l/by-id");
  for (const char* name : {"video10", "video2", "video", "videos1", "null"}) {
    std::ofstream(root / "dev" / name) << "";
  }
  fs::create_symlink("../../video2", root / "dev/v4l/by-id/usb-Maker_Cam-video-index0");
  fs::create_symlink("../../video77", root / "dev/v4l/by-id/usb-Gone-video-index0");
  fs::create_directories(root / "sys/class/video4linux/video2");
  std::ofstream(root / "sys/class/video4linux/video2/name") << "Maker Cam\n";
  const auto cameras = list_cameras(root, [](CameraInfo& c) { c.problem = "asked " + c.device; });
  ASSERT_EQ(cameras.size(), 2U);
  EXPECT_EQ(cameras[0].device, "/dev/video2");
  EXPECT_EQ(cameras[0].name, "Maker Cam");
  EXPECT_EQ(cameras[0].by_id, "/dev/v4l/by-id/usb-Maker_Cam-video-index0");
  EXPECT_EQ(cameras[1].device, "/dev/video10");
  EXPECT_EQ(cameras[1].problem, "asked /dev/video10");
  EXPECT_TRUE(list_cameras(root / "nothing").empty());
}

TEST(Cameras, ADeviceThatIsNoneSaysSo) {
  CameraInfo null{.device = "/dev/null"};
  ask_v4l2(null);
  EXPECT_EQ(null.kind, CameraKind::unknown);
  EXPECT_EQ(null.problem, "it does not answer as a video device");
  CameraInfo missing{.device = "/dev/video999"};
  ask_v4l2(missing);
  EXPECT_EQ(missing.problem, "No such file or directory");
}

TEST(Cameras, ModeIsRawUnlessTooSlow) {
  EXPECT_EQ(best_mode(computer()[2].modes), (CameraMode{"YUYV", 640, 480, 30.0}));
  EXPECT_EQ(best_mode({{"YUYV", 640, 480, 15.0}, {"MJPG", 640, 480, 30.0}}),
            (CameraMode{"MJPG", 640, 480, 30.0}));
  EXPECT_EQ(best_mode({{"YUYV", 640, 480, 24.99}, {"MJPG", 640, 480, 30.0}})->format, "YUYV");
  EXPECT_EQ(best_mode({{"YUYV", 1280, 720, 10.0}, {"YUYV", 320, 240, 30.0}})->width, 320);
  EXPECT_EQ(best_mode({{"YUYV", 1280, 720, 5.0}, {"MJPG", 1280, 720, 15.0}})->format, "MJPG");
}

TEST(Cameras, ModeCanBeDecodedAndHasColour) {
  EXPECT_EQ(best_mode({{"H264", 640, 480, 30.0}}), std::nullopt);
  EXPECT_EQ(best_mode({}), std::nullopt);
  EXPECT_EQ(best_mode({{"GREY", 640, 480, 30.0}, {"YUYV", 640, 480, 5.0}})->format, "YUYV");
  EXPECT_FALSE(has_colour(computer()[0]));
  EXPECT_TRUE(has_colour(computer()[2]));
}

TEST(Cameras, AreFoundByNumberDeviceAndName) {
  const auto cameras = computer();
  EXPECT_EQ(find_camera(cameras, ""), "/dev/video2") << "the first with colours";
  EXPECT_EQ(find_camera(cameras, "1"), "/dev/video1") << "what is named is taken, whatever it is";
  EXPECT_EQ(find_camera(cameras, "/dev/video4"), "/dev/video4");
  EXPECT_EQ(find_camera(cameras, "c920"), "/dev/video4");
  EXPECT_EQ(find_camera(cameras, "046D"), "/dev/video4");
  EXPECT_EQ(find_camera(cameras, "hp hd"), "/dev/video2");
  EXPECT_EQ(find_camera(cameras, "codec"), std::nullopt);
  EXPECT_EQ(find_camera({}, ""), std::nullopt);
  EXPECT_THROW(find_camera(cameras, "hp"), Error) << "two cameras of different names";
}

TEST(Cameras, AFileGoesBeforeTheNameOfACamera) {
  const ScratchFolder scratch;
  const fs::path folder = scratch.path();
  std::ofstream(folder / "c920") << "";
  const std::string file = (folder / "c920").string();
  EXPECT_EQ(with_camera_found("c920", computer), "/dev/video4");
  EXPECT_EQ(with_camera_found("clip.mp4", computer), "clip.mp4");
  EXPECT_EQ(with_camera_found("", computer), "/dev/video2");
  EXPECT_EQ(with_camera_found("", [] { return std::vector<CameraInfo>(); }), "0");

  // No camera is opened where none can be meant.
  const auto unasked = []() -> std::vector<CameraInfo> { throw std::logic_error("asked"); };
  for (const std::string& input :
       {file, std::string("rtsp://c920"), std::string("1"), scratch.path().string()}) {
    EXPECT_EQ(with_camera_found(input, unasked), input);
  }
}

TEST(Cameras, AMetadataDeviceNamesTheOneWithImages) {
  EXPECT_EQ(
      why_no_images(computer(), "/dev/video1"),
      "/dev/video1 is the metadata device of HP Wide Vision: HP HD and gives no images; its images come from "
      "/dev/video2");
  EXPECT_EQ(why_no_images(computer(), "/dev/video10"), "/dev/video10 (codec) is not a camera");
  EXPECT_EQ(why_no_images(computer(), "/dev/video2"), "");
}

}  // namespace
}  // namespace telemime
