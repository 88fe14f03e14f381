// SPDX-License-Identifier: Apache-2.0
#include "telemime/streaming/url.h"

#include <gtest/gtest.h>

#include "telemime/core/testing_errors.h"

namespace telemime {
namespace {

constexpr std::string_view kExample = "x://host:1";

TEST(Url, HasItsParts) {
  const SendUrl url = parse_url("BAP+tcp://my-host.example:80/a/b?x=1&y=a=b", kExample);
  EXPECT_EQ(url.text, "BAP+tcp://my-host.example:80/a/b?x=1&y=a=b");
  EXPECT_EQ(url.scheme, "bap+tcp");
  EXPECT_EQ(url.host, "my-host.example");
  EXPECT_EQ(url.port, 80);
  EXPECT_EQ(url.path, "/a/b");
  EXPECT_EQ(url.options, (std::vector<std::pair<std::string, std::string>>{{"x", "1"}, {"y", "a=b"}}));
}

TEST(Url, MostPartsMayBeMissing) {
  EXPECT_FALSE(parse_url("vmc://localhost", kExample).port);
  EXPECT_EQ(parse_url("vmc://localhost?a=b", kExample).host, "localhost");
  EXPECT_EQ(parse_url("vmc://localhost", kExample).path, "/");
  EXPECT_EQ(parse_url("s://[::1]:7", kExample).host, "::1");
  EXPECT_EQ(parse_url("s://[::1]", kExample).host, "::1");
  EXPECT_FALSE(parse_url("s://host:", kExample).port) << "RFC 3986 allows an empty port";
}

TEST(Url, WhatIsNoneIsRefusedWithARightOne) {
  for (const char* const text : {"",
                                 "localhost:39539",
                                 "://host",
                                 "vmc:/host",
                                 "vmc://",
                                 "vmc://:4150",
                                 "vmc://host:port",
                                 "vmc://host:65536",
                                 "vmc://host:0",
                                 "vmc://host:-1",
                                 "vmc://ho st",
                                 "vmc://host\n",
                                 "vmc://user@host:1",
                                 "vmc://[::1",
                                 "vmc://[::1]x",
                                 "vmc://h:1?a",
                                 "vmc://h:1?=b",
                                 "vmc://h:1?a=b&",
                                 "vmc://h:1#x",
                                 "vmc://h:1?a=b#x",
                                 "vmc://h\xc3\xa9"}) {
    const std::string message = error_of(ErrorKind::usage, [&] { parse_url(text, kExample); });
    EXPECT_NE(message.find(kExample), std::string::npos) << text << ": " << message;
  }
  EXPECT_THROW(parse_url("vmc://" + std::string(3000, 'x'), kExample), Error);
}

TEST(Url, OptionsHaveAFirstAndOtherValues) {
  const SendUrl url = parse_url("s://h?a=2", kExample);
  EXPECT_EQ(option(url, "a", {"1", "2"}), "2");
  EXPECT_EQ(option(url, "b", {"1", "2"}), "1");
  EXPECT_THROW(option(url, "a", {"1", "3"}), Error);
  EXPECT_NO_THROW(check_options(url, {"b", "a"}));
  EXPECT_THROW(check_options(url, {"b"}), Error);
}

TEST(Url, AUserMayStandBeforeTheHostWhereThatIsWanted) {
  const SendUrl url = parse_url("x://a.b:c%3a%2Fd@host:7/p?q=1", kExample, UrlCredentials::accepted);
  EXPECT_EQ(url.user, "a.b");
  EXPECT_EQ(url.password, "c:/d");
  EXPECT_EQ(url.host, "host");
  EXPECT_EQ(url.port, 7);
  EXPECT_EQ(url.path, "/p");
  EXPECT_EQ(url.text, "x://a.b@host:7/p?q=1");
  EXPECT_EQ(parse_url("x://a@[::1]", kExample, UrlCredentials::accepted).host, "::1");
  EXPECT_EQ(parse_url("x://a:@h", kExample, UrlCredentials::accepted).password, "");
  EXPECT_EQ(parse_url("x://a:b:c@h", kExample, UrlCredentials::accepted).password, "b:c");
  EXPECT_EQ(parse_url("x://h?q=a@b", kExample, UrlCredentials::accepted).user, "");
  EXPECT_THROW(parse_url("x://:c@h", kExample, UrlCredentials::accepted), Error);
  EXPECT_THROW(parse_url("x://a:%4@h", kExample, UrlCredentials::accepted), Error);
  EXPECT_THROW(parse_url("x://a:b@h", kExample), Error);
}

TEST(Url, APasswordIsNotShown) {
  EXPECT_EQ(without_password("x://a:secret@h:1/p?q=1"), "x://a@h:1/p?q=1");
  EXPECT_EQ(without_password("x://a@h:1/p"), "x://a@h:1/p");
  EXPECT_EQ(without_password("x://h:1/p?q=a@b"), "x://h:1/p?q=a@b");
  EXPECT_EQ(without_password("x://[::1]:80/p"), "x://[::1]:80/p");
  EXPECT_EQ(without_password("no URL"), "no URL");
  for (const char* const text :
       {"x://a:secret@h", "x://a:secret@h:1:2", "x://a:sec@secret@h", "x://a:x/secret@h/p/q",
        "x://a:x?secret@h/p", "mqtt://a:1/secret@h/p/q", "mqtt://a:secret@h/p?n=b@c", "MQTT://a:12?secret@h",
        "mqtt://a:secret@h\n", "x://:secret@h", "mqtt://a:x#secret@h"}) {
    EXPECT_EQ(without_password(text).find("secret"), std::string::npos) << without_password(text);
    for (const UrlCredentials credentials : {UrlCredentials::rejected, UrlCredentials::accepted}) {
      try {
        EXPECT_EQ(parse_url(text, kExample, credentials).text.find("secret"), std::string::npos) << text;
      } catch (const Error& error) {
        EXPECT_EQ(std::string(error.what()).find("secret"), std::string::npos) << error.what();
      }
    }
  }
}

TEST(Url, TheSecretOfARoomsLinkIsNotShown) {
  const SendUrl url = parse_url("http://h:7080/room?name=Ana#k=Sec-ret_1", kExample);
  EXPECT_EQ(url.text, "http://h:7080/room?name=Ana");
  EXPECT_EQ(url.password, "Sec-ret_1");
  EXPECT_EQ(url.path, "/room");
  EXPECT_EQ(find_option(url, "name"), "Ana");
  EXPECT_EQ(without_password("https://h/room#k=secret"), "https://h/room");
  EXPECT_EQ(without_password("https://h/room"), "https://h/room");
  for (const char* const bad : {"http://h/room#", "http://h/room#k=", "http://h/room#x=a",
                                "http://h/room#k=a b", "http://h/room#k=a#k=b", "http://h/room#k=a/b"}) {
    EXPECT_THROW(parse_url(bad, kExample), Error) << bad;
  }
  EXPECT_THROW(parse_url("http://h/room#k=" + std::string(201, 'a'), kExample), Error);
}

TEST(Url, HostAndPortIsParsedStrictly) {
  EXPECT_EQ(parse_host_and_port("LocalHost:80").value().host, "localhost");
  EXPECT_EQ(parse_host_and_port("LocalHost:80").value().port, 80);
  EXPECT_FALSE(parse_host_and_port("localhost").value().port);
  EXPECT_EQ(parse_host_and_port("[0:0::1]:7").value().host, "::1");
  for (const char* const bad : {"", "h/", "h:", "h:0", "h:65536", "h:+1", "u@h", "h?", "127.1", "a b", "[::1",
                                "[]", "::1", "%68", "h\r\n"}) {
    EXPECT_FALSE(parse_host_and_port(bad)) << bad;
  }
}

TEST(Url, BracketsAroundIpv6) {
  EXPECT_EQ(host_and_port("::1", 80), "[::1]:80");
  EXPECT_EQ(host_and_port("localhost", 80), "localhost:80");
}

}  // namespace
}  // namespace telemime
