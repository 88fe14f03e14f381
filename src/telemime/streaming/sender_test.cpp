// SPDX-License-Identifier: Apache-2.0
#include "telemime/streaming/sender.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "telemime/core/testing_errors.h"
#include "telemime/streaming/all.h"

namespace telemime {
namespace {

std::string refusal(const std::string& url) {
  return error_of(ErrorKind::usage, [&] { make_sender(url); });
}

// Options stand before the secret of a room's link.
std::string with_options(std::string_view example, const std::string& options) {
  std::string url(example);
  return url.insert(std::min(url.find('#'), url.size()), "?" + options);
}

TEST(Senders, ExamplesCanBeTypedAsTheyAre) {
  for (const SenderKind& kind : sender_kinds()) {
    EXPECT_EQ(kind.example.substr(0, kind.scheme.size() + 3), std::string(kind.scheme) + "://");
    const auto sender = make_sender(std::string(kind.example));
    EXPECT_EQ(sender->status().url, without_password(std::string(kind.example)));
    EXPECT_NO_THROW(make_sender(with_options(kind.example, "mirror=1")));
  }
}

TEST(Senders, ASchemeThatIsUnknownIsAnsweredByTheKnownOnes) {
  const std::string words = refusal("osc://localhost:1");
  for (const SenderKind& kind : sender_kinds()) {
    EXPECT_NE(words.find(kind.example), std::string::npos) << words;
  }
}

TEST(Senders, BadUrlsAreRefusedInWords) {
  EXPECT_NE(refusal("").find("vmc://localhost:39539"), std::string::npos);
  EXPECT_NE(refusal("vmc://").find("the computer to send to"), std::string::npos);
  EXPECT_NE(refusal("vmc://localhost:0").find("port"), std::string::npos);
  EXPECT_NE(refusal("vmc://localhost/path").find("vmc://localhost:39539"), std::string::npos);
  EXPECT_NE(refusal("vmc://localhost?bundles=1").find("bundle, positions, root, expressions, mirror"),
            std::string::npos);
  EXPECT_NE(refusal("vmc://localhost?positions=some").find("all, hips"), std::string::npos);
  EXPECT_NE(refusal("vmc://localhost?mirror=yes").find("0, 1"), std::string::npos);
  EXPECT_NE(refusal("bap+tcp://localhost").find("bap+tcp://localhost:5000"), std::string::npos);
  EXPECT_NE(refusal("bap+tcp://localhost:5000?profile=poser").find("vreng-3.1"), std::string::npos);
  EXPECT_NE(refusal("ws://:80/").find("the computer to send to"), std::string::npos);
  EXPECT_NE(refusal("wss://localhost").find("ws://localhost:8080/motion"), std::string::npos);
  EXPECT_NE(refusal("vmc://user:word@localhost").find("vmc://user@localhost"), std::string::npos);
  EXPECT_EQ(refusal("vmc://h#k=secret").find("secret"), std::string::npos);
}

TEST(Senders, UrlsThatMeanTheSameAreToldByIt) {
  const auto same = [](const std::string& a, const std::string& b) { return meaning_of(a) == meaning_of(b); };
  EXPECT_TRUE(same("vmc://localhost", "vmc://localhost:39539"));
  EXPECT_TRUE(same("VMC://LocalHost/", "vmc://127.0.0.1?bundle=1&mirror=0"));
  EXPECT_TRUE(same("vmc://h?root=moves&bundle=0", "vmc://h?bundle=0&root=moves&positions=all"));
  EXPECT_TRUE(same("vmc://h", "vmc://h?expressions=vrm0"));
  EXPECT_TRUE(same("vmc://h?bundle=0&bundle=1", "vmc://h?bundle=0")) << "the first one counts";
  EXPECT_TRUE(same("vmc://[0:0::1]", "vmc://[::1]:39539"));
  EXPECT_TRUE(same("ws://h:80", "ws://h/?mirror=0"));
  EXPECT_TRUE(same("bap+tcp://h:5000", "bap+tcp://h:5000?profile=iso"));

  EXPECT_FALSE(same("vmc://localhost", "vmc://localhost:39540"));
  EXPECT_FALSE(same("vmc://localhost", "vmc://localhost?mirror=1"));
  EXPECT_FALSE(same("vmc://h", "vmc://h?expressions=arkit"));
  EXPECT_FALSE(same("vmc://a", "vmc://b"));
  EXPECT_FALSE(same("bap+tcp://h:4150", "ws://h:4150"));
  EXPECT_FALSE(same("ws://h:80/a", "ws://h:80/A")) << "only a host is the same in capitals";
  EXPECT_FALSE(same("ws://h:80/?a=1&b=2", "ws://h:80/?b=2&a=1")) << "what order means is the receiver's";
}

TEST(Senders, EveryOptionOfTheTableIsOneAndItsFirstValueTheDefault) {
  EXPECT_EQ(meaning_of("vmc://localhost"),
            "vmc://127.0.0.1:39539/&bundle=1&expressions=vrm0&mirror=0&positions=all&root=still");
  for (const SenderKind& kind : sender_kinds()) {
    const std::string meaning = meaning_of(std::string(kind.example));
    const std::string options = meaning.substr(meaning.find('&') + 1);
    EXPECT_NO_THROW(make_sender(with_options(kind.example, options))) << options;
  }
}

}  // namespace
}  // namespace telemime
