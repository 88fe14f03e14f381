// SPDX-License-Identifier: Apache-2.0
#include "telemime/streaming/web_origin.h"

#include <gtest/gtest.h>

#include "telemime/core/testing_errors.h"

namespace telemime {
namespace {

constexpr const char* local = "192.168.1.5";

TEST(WebNames, TheNamesOfThisComputerAreRight) {
  const WebNames names(7070, {});
  for (const char* host : {"localhost:7070", "LocalHost:7070", "127.0.0.1:7070", "[::1]:7070",
                           "[0:0::1]:7070", "192.168.1.5:7070"}) {
    EXPECT_TRUE(names.host(host, local)) << host;
    EXPECT_TRUE(names.origin(std::string("http://") + host, local)) << host;
  }
}

TEST(WebNames, OtherNamesAreWrong) {
  const WebNames names(7070, {});
  for (const char* host : {"",
                           "evil.com",
                           "evil.com:7070",
                           "localhost",
                           "localhost:",
                           "localhost:80",
                           "localhost:7071",
                           "localhost:07070x",
                           "localhost:70700",
                           "localhost:+7070",
                           "localhost:0",
                           "localhost.evil.com:7070",
                           "evil-localhost:7070",
                           "localhost.:7070",
                           "127.0.0.1.nip.io:7070",
                           "127.0.0.2:7070",
                           "127.1:7070",
                           "2130706433:7070",
                           "[::1]",
                           "[::1]x:7070",
                           "[::2]:7070",
                           "[::1",
                           "::1",
                           "[]:7070",
                           "a@localhost:7070",
                           "localhost:7070@evil.com",
                           "localhost:7070, localhost:7070",
                           "localhost:7070/",
                           " localhost:7070",
                           "0.0.0.0:7070",
                           "192.168.1.6:7070"}) {
    EXPECT_FALSE(names.host(host, local)) << host;
    EXPECT_FALSE(names.origin(std::string("http://") + host, local)) << host;
  }
}

TEST(WebNames, OriginsNeedAScheme) {
  const WebNames names(7070, {});
  for (const char* origin :
       {"", "null", "localhost:7070", "file://", "ftp://localhost:7070", "http:/localhost:7070",
        "http://localhost:7070/", "http://http://localhost:7070", "chrome-extension://abc",
        "http://localhost:7070\r\n", "https://localhost", "http://localhost"}) {
    EXPECT_FALSE(names.origin(origin, local)) << origin;
  }
}

TEST(WebNames, ThePortMayBeLeftOutWhereItIsTheSchemes) {
  EXPECT_TRUE(WebNames(80, {}).host("localhost", local));
  EXPECT_TRUE(WebNames(80, {}).origin("http://localhost", local));
  EXPECT_FALSE(WebNames(80, {}).origin("https://localhost", local));
}

TEST(WebNames, FurtherHostsAreRight) {
  const WebNames names(7070, {"Studio.local", "proxy.example:443", "[fd00::1]:8080"});
  EXPECT_TRUE(names.host("studio.local:7070", local));
  EXPECT_FALSE(names.host("studio.local", local));
  EXPECT_TRUE(names.host("proxy.example:443", local));
  EXPECT_TRUE(names.origin("https://proxy.example", local));
  EXPECT_FALSE(names.origin("http://proxy.example", local));
  EXPECT_TRUE(names.host("[fd00:0::1]:8080", local));
  EXPECT_FALSE(names.host("[fd00::1]:7070", local));
}

TEST(WebNames, AHostThatIsNoneIsAnError) {
  for (const char* host : {"", "http://studio", "a b", "studio:", "studio:x", "studio:0", "*", "[::1"}) {
    EXPECT_NE(error_of(ErrorKind::usage, [&] { WebNames(7070, {host}); }), "") << host;
  }
}

}  // namespace
}  // namespace telemime
