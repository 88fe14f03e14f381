// SPDX-License-Identifier: Apache-2.0
#include "telemime/capture/input_kind.h"

#include <gtest/gtest.h>

#include "telemime/capture/testing.h"

namespace telemime {
namespace {

TEST(InputKind, FollowsFromTheName) {
  EXPECT_EQ(input_kind("0"), InputKind::camera);
  EXPECT_EQ(input_kind("12"), InputKind::camera);
  EXPECT_EQ(input_kind("/dev/video2"), InputKind::device);
  EXPECT_EQ(input_kind("/dev/v4l/by-id/some-camera"), InputKind::device);
  for (const char* url : {"rtsp://host/path", "http://host:8080/video.mp4", "udp://@:5000", "RTMP://h/x"}) {
    EXPECT_EQ(input_kind(url), InputKind::stream) << url;
  }
  for (const char* pattern : {"a/frame_%04d.png", "%d.jpg", "a/*.png", "shot?.jpg", "[ab].png"}) {
    EXPECT_EQ(input_kind(pattern), InputKind::pattern) << pattern;
  }
  EXPECT_EQ(input_kind("nowhere/one.PNG"), InputKind::image);
  for (const char* video : {"clip.mp4", "nowhere/clip", "-1", "100%", "file:///nowhere/clip.mkv"}) {
    EXPECT_EQ(input_kind(video), InputKind::video_file) << video;
  }
}

TEST(InputKind, FollowsFromTheFileSystemOtherwise) {
  const ScratchFolder scratch;
  EXPECT_EQ(input_kind(scratch.file("")), InputKind::folder);
  const std::string awkward = scratch.file("take[2]_100%d.mp4");
  EXPECT_EQ(input_kind(awkward), InputKind::pattern);
  testing::write_bytes(awkward, "x");
  EXPECT_EQ(input_kind(awkward), InputKind::video_file);
}

TEST(InputKind, NotAllBelowDevIsADevice) {
  EXPECT_EQ(input_kind("/dev/shm"), InputKind::folder);
  EXPECT_EQ(input_kind("/dev/shm/frame_%04d.png"), InputKind::pattern);
  EXPECT_EQ(input_kind("/dev/shm/nowhere.mp4"), InputKind::video_file);
  EXPECT_EQ(input_kind("/dev/video0"), InputKind::device);
}

TEST(InputKind, FileUrlsArePaths) {
  EXPECT_EQ(without_file_scheme("file:///tmp/a.mp4"), "/tmp/a.mp4");
  EXPECT_EQ(without_file_scheme("/tmp/a.mp4"), "/tmp/a.mp4");
}

TEST(ShownUrl, HasNoSecrets) {
  EXPECT_EQ(shown_url("rtsp://ana:secret@cam.local:554/stream1"), "rtsp://cam.local:554/stream1");
  EXPECT_EQ(shown_url("rtsp://ana:se/cr@et@cam/stream1"), "rtsp://cam/stream1");
  EXPECT_EQ(shown_url("rtsp://ana@cam/stream1"), "rtsp://cam/stream1");
  EXPECT_EQ(shown_url("http://10.0.0.5/video.cgi?user=ana&pwd=se@cret"), "http://10.0.0.5/video.cgi");
  EXPECT_EQ(shown_url("http://ana:secret@10.0.0.5?pwd=secret"), "http://10.0.0.5");
  EXPECT_EQ(shown_url("http://10.0.0.5:80/video?pwd=se@cret"), "http://10.0.0.5:80/video");
  EXPECT_EQ(shown_url("rtsp://ana:se#cr?et@cam/stream1"), "rtsp://cam/stream1");
  EXPECT_EQ(shown_url("rtsp://cam:554/live/user=ana&password=secret&channel=1/x"), "rtsp://cam:554/live/");
}

TEST(ShownUrl, KeepsOtherTextUnchanged) {
  for (const char* url : {"http://127.0.0.1:8080/video", "rtsp://[::1]:554/a/b", "http://cam/@home/video",
                          "http://cam:8080/@home/video", "rtsp://[::1]/a@b", "rtsp://[::1]:554/a@b", "0",
                          "/dev/video0", "rtsp://cam"}) {
    EXPECT_EQ(shown_url(url), url);
  }
}

}  // namespace
}  // namespace telemime
