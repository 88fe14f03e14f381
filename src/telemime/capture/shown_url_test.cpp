// SPDX-License-Identifier: Apache-2.0
#include "telemime/capture/shown_url.h"

#include <gtest/gtest.h>

namespace telemime {
namespace {

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
