// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "meeting/transport/senders.h"
#include "telemime/core/errors.h"

namespace telemime::meeting {
namespace {

std::string refusal(const std::string& url) {
  try {
    make_sender(url, kAllSenderKinds);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::usage);
    return error.what();
  }
  return "nothing was refused";
}

std::string meaning(const std::string& url) {
  return meaning_of(url, kAllSenderKinds);
}

// Options precede the access key of a link.
std::string with_options(std::string_view example, const std::string& options) {
  std::string url(example);
  return url.insert(std::min(url.find('#'), url.size()), "?" + options);
}

TEST(MeetingSenders, ExamplesAreValid) {
  for (const SenderKind& kind : kAllSenderKinds) {
    EXPECT_EQ(kind.example.substr(0, kind.scheme.size() + 3), std::string(kind.scheme) + "://");
    const auto sender = make_sender(std::string(kind.example), kAllSenderKinds);
    EXPECT_EQ(sender->status().url, without_password(std::string(kind.example)));
    EXPECT_NO_THROW(make_sender(with_options(kind.example, "mirror=1"), kAllSenderKinds));
  }
}

TEST(MeetingSenders, UnknownSchemeNamesTheKnownOnes) {
  const std::string message = refusal("osc://localhost:1");
  for (const SenderKind& kind : kAllSenderKinds) {
    EXPECT_NE(message.find(kind.example), std::string::npos) << message;
  }
}

TEST(MeetingSenders, EqualUrlsHaveEqualMeanings) {
  const auto same = [](const std::string& a, const std::string& b) { return meaning(a) == meaning(b); };
  EXPECT_TRUE(same("mqtt://h/a/b", "mqtt://h:1883/a/b?mirror=0"));
  EXPECT_TRUE(same("mqtt://h/a/b", "mqtt://h/a/b?look=plain"));
  EXPECT_FALSE(same("mqtt://h/a/b", "mqtt://h/a/b?look=robot"));
  EXPECT_TRUE(same("http://h/room", "http://h/room?look=plain#k=a"));
  EXPECT_TRUE(same("mqtts://u:one@h/a/b", "mqtts://u:two@h:8883/a/b"));
  EXPECT_TRUE(same("mqtts://u:one@h/a/b", "mqtts://u@h/a/b"));
  EXPECT_TRUE(same("http://h/room#k=a", "http://h:80/room#k=b")) << "a secret says nothing of where";
  EXPECT_TRUE(same("http://h/room#k=a", "http://h/room"));
  EXPECT_FALSE(same("mqtt://u:x@h/a/b", "mqtt://v:x@h/a/b")) << "another participant";
  EXPECT_FALSE(same("mqtt://h/a/b", "mqtt://h/a/c"));
}

TEST(MeetingSenders, PasswordsAreNeverShown) {
  const std::string url = "mqtt://studio.p01:secret@127.0.0.1:9/home/studio?name=Ana";
  EXPECT_EQ(meaning(url).find("secret"), std::string::npos);
  EXPECT_EQ(make_sender(url, kAllSenderKinds)->status().url,
            "mqtt://studio.p01@127.0.0.1:9/home/studio?name=Ana");
  for (const char* const bad : {"mqtt://u:secret@h",
                                "mqtt://u:secret@h/a",
                                "mqtt://u:secret@h/a/b?x=1",
                                "mqtt://u:secret@h:0/a/b",
                                "mqtt://u:secret@/a/b",
                                "mqtt://u:secret@h:x/a/b",
                                "mqtt://u:secret@h/a/b#c",
                                "mqtt://u:sec/secret@h/a/b",
                                "mqtt://u:1/secret@h/a/b",
                                "mqtt://u:%zzsecret@h/a/b",
                                "mqtt://u:secret@h/a/b?mirror=2",
                                "mqtt://u:secret@h/a/b?name=",
                                "mqtt://u:secret@h/a/b?name=%0a",
                                "mqtt://u:secret@h/a/b?seat=x",
                                "mqtt://u:secret@h/a/b?ca=x",
                                "mqtts://u:secret@h/a/b?ca=/none",
                                "mqtt://h/a/b?password=secret",
                                "mqttx://u:secret@h/a/b",
                                "http://h/room#secret",
                                "http://h/room#k=secret!",
                                "http://h/else#k=secret",
                                "http://h:0x/room#k=secret",
                                "https://h/room?ca=/none&x=1#k=secret",
                                "http://h/room?seat=x#k=secret",
                                "vmc://h#k=secret",
                                "htp://h/room#k=secret"}) {
    EXPECT_EQ(refusal(bad).find("secret"), std::string::npos) << refusal(bad);
    EXPECT_NE(refusal(bad), "nothing was refused") << bad;
  }
}

TEST(MeetingSenders, FirstValuesAreDefaults) {
  for (const SenderKind& kind : kAllSenderKinds) {
    const std::string all = meaning(std::string(kind.example));
    const std::string options = all.substr(all.find('&') + 1);
    EXPECT_NO_THROW(make_sender(with_options(kind.example, options), kAllSenderKinds)) << options;
  }
}

}  // namespace
}  // namespace telemime::meeting
