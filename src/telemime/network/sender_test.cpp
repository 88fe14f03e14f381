// SPDX-License-Identifier: Apache-2.0
#include "telemime/network/sender.h"

#include <gtest/gtest.h>

#include "telemime/core/errors.h"
#include "telemime/network/all.h"

namespace telemime {
namespace {

std::string refusal(const std::string& url) {
  try {
    make_sender(url);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::usage);
    return error.what();
  }
  return "nothing was refused";
}

TEST(Senders, ExamplesCanBeTypedAsTheyAre) {
  for (const SenderKind& kind : sender_kinds()) {
    EXPECT_EQ(kind.example.substr(0, kind.scheme.size() + 3), std::string(kind.scheme) + "://");
    const auto sender = make_sender(std::string(kind.example));
    EXPECT_EQ(sender->status().url, kind.example);
    EXPECT_NO_THROW(make_sender(std::string(kind.example) + "?mirror=1"));
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
  EXPECT_NE(refusal("vmc://").find("which computer"), std::string::npos);
  EXPECT_NE(refusal("vmc://localhost:0").find("port"), std::string::npos);
  EXPECT_NE(refusal("vmc://localhost/path").find("vmc://localhost:39539"), std::string::npos);
  EXPECT_NE(refusal("vmc://localhost?bundles=1").find("bundle, positions, root, mirror"), std::string::npos);
  EXPECT_NE(refusal("vmc://localhost?positions=some").find("all, hips"), std::string::npos);
  EXPECT_NE(refusal("vmc://localhost?mirror=yes").find("0, 1"), std::string::npos);
  EXPECT_NE(refusal("bap+tcp://localhost").find("bap+tcp://localhost:5000"), std::string::npos);
  EXPECT_NE(refusal("bap+tcp://localhost:5000?profile=poser").find("vreng-3.1"), std::string::npos);
  EXPECT_NE(refusal("bap+serve://:4150?profile=poser").find("vreng-3.1"), std::string::npos);
  EXPECT_NE(refusal("bap+serve://:4150/x").find("path"), std::string::npos);
  EXPECT_NE(refusal("ws://:80/").find("which computer"), std::string::npos);
  EXPECT_NE(refusal("wss://localhost").find("ws://localhost:8080/motion"), std::string::npos);
}

}  // namespace
}  // namespace telemime
