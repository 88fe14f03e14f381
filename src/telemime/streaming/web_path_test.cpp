// SPDX-License-Identifier: Apache-2.0
#include "telemime/streaming/web_path.h"

#include <gtest/gtest.h>

#include "telemime/core/random.h"
#include "telemime/core/text.h"

namespace telemime {
namespace {

TEST(WebPath, PlainTargetsAreTaken) {
  EXPECT_EQ(web_path("/"), "/");
  EXPECT_EQ(web_path("/?a=1"), "/");
  EXPECT_EQ(web_path("/a/b.js?x=/../c#d"), "/a/b.js");
  EXPECT_EQ(web_path("/a%20b/%C3%A4"), "/a b/\xC3\xA4");
  EXPECT_EQ(web_path("//a///b//"), "/a/b/");
  EXPECT_EQ(web_path("/./a/./b/."), "/a/b");
  EXPECT_EQ(web_path("/a%2Fb"), "/a/b");
  EXPECT_EQ(web_path("/a.b/.c"), "/a.b/.c");
}

TEST(WebPath, DecodesOnce) {
  EXPECT_EQ(web_path("/%252e%252e/etc/passwd"), "/%2e%2e/etc/passwd");
  EXPECT_EQ(web_path("/%2500"), "/%00");
}

TEST(WebPath, WaysOutOfTheFolderAreRefused) {
  for (const char* target :
       {"/..", "/../etc/passwd", "/a/../../b", "/%2e%2e/etc/passwd", "/%2E./x", "/.%2e/x", "/..%2fx",
        "/a%2f..%2fb", "/..%5cwindows", "/a\\..\\b", "/%5c", "/a..b", "/....//x", "/..;/x", "/.%2E%2Fx"}) {
    EXPECT_EQ(web_path(target), std::nullopt) << target;
  }
}

TEST(WebPath, WhatIsNotPlainTextIsRefused) {
  for (const char* target : {"/%00", "/a%00.js", "/%0d%0aSet-Cookie:x", "/%1f", "/%7f", "/%c2%85", "/a\tb",
                             "/%c0%ae%c0%ae/x",                         // over-long "."
                             "/%c0%af", "/%e0%80%af", "/%f0%80%80%af",  // over-long "/"
                             "/%ed%a0%80", "/%f4%90%80%80", "/%ff", "/%80", "/%c3", "/%e2%82", "/%c3%28"}) {
    EXPECT_EQ(web_path(target), std::nullopt) << target;
  }
}

TEST(WebPath, MalformedTargetsAreRefused) {
  for (const char* target : {"", "a", "*", "http://localhost/", "localhost:80", "/%", "/%4", "/%g0", "/%4g",
                             "/%%41", "?", "/% 1", "/%u002e"}) {
    EXPECT_EQ(web_path(target), std::nullopt) << target;
  }
}

TEST(WebPath, FullWidthDotsStayWhatTheyAre) {
  EXPECT_EQ(web_path("/\xEF\xBC\x8E\xEF\xBC\x8E/x"), "/\xEF\xBC\x8E\xEF\xBC\x8E/x");
}

TEST(WebPath, NoTargetBreaksThePromise) {
  Random random(7, 1);
  const std::string letters = "/.%2e5cfC0aAfF\\?# x\x80\xC0\xAE";
  for (int i = 0; i < 100'000; ++i) {
    std::string target = "/";
    const int size = static_cast<int>(random.below(16));
    for (int k = 0; k < size; ++k) {
      target += letters[random.below(static_cast<std::uint32_t>(letters.size()))];
    }
    const std::optional<std::string> path = web_path(target);
    if (!path) {
      continue;
    }
    ASSERT_TRUE(path->starts_with('/')) << target;
    ASSERT_EQ(path->find(".."), std::string::npos) << target;
    ASSERT_EQ(path->find("//"), std::string::npos) << target;
    ASSERT_EQ(path->find("/./"), std::string::npos) << target;
    ASSERT_EQ(path->find('\\'), std::string::npos) << target;
    ASSERT_EQ(path->find('\0'), std::string::npos) << target;
    ASSERT_TRUE(printable_length(*path)) << target;
  }
}

TEST(WebType, ByEnding) {
  EXPECT_EQ(web_type("/index.html"), "text/html; charset=utf-8");
  EXPECT_EQ(web_type("a.min.js"), "text/javascript; charset=utf-8");
  EXPECT_EQ(web_type("plain.vrm"), "model/gltf-binary");
  EXPECT_EQ(web_type("html"), "application/octet-stream");
}

}  // namespace
}  // namespace telemime
