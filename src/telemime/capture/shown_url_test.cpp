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
}

TEST(ShownUrl, LeavesTheRestAsItIs) {
  for (const char* url : {"http://127.0.0.1:8080/video", "rtsp://[::1]:554/a/b", "http://cam/@home/video",
                          "0", "/dev/video0", "rtsp://cam"}) {
    EXPECT_EQ(shown_url(url), url);
  }
}

}  // namespace
}  // namespace telemime
