// SPDX-License-Identifier: Apache-2.0
#include "telemime/streaming/bap_session.h"

#include <gtest/gtest.h>

namespace telemime {
namespace {

/// What a client that sends these pieces is understood to ask for: p for play, s for stop, x at its end.
struct Heard {
  BapSession session;
  std::string acts;
  explicit Heard(std::initializer_list<std::string_view> pieces) {
    for (const std::string_view piece : pieces) {
      const bool stays = session.take(
          piece, [&](BapSession::Command c) { acts += c == BapSession::Command::play ? 'p' : 's'; });
      if (!stays) {
        acts += 'x';
        return;
      }
    }
  }
};

TEST(BapSession, TakesCommandsWithAndWithoutLineBreaks) {
  EXPECT_EQ(Heard({"setup p=5000 r=10.00 ", "play f=hi.bap", "stop"}).acts, "ps");
  EXPECT_EQ(Heard({"setup p=5000", "play f=hi.b", "ap ", "stop"}).acts, "ps");
  EXPECT_EQ(Heard({"setup p=5000 r=10.00 ", "play f=hi.bap", " stop"}).acts, "ps");
  EXPECT_EQ(Heard({"setup p=5000 r=10.00 play f=hi.bap\nstop\nteardown\n"}).acts, "psx");
  EXPECT_EQ(Heard({"setup p=5000\r\n", "play\r\n", "play", " f=a\n", "teardown"}).acts, "ppx");
  EXPECT_EQ(Heard({"se", "tup p=5", "000 pl", "ay "}).acts, "p");
}

TEST(BapSession, RemembersTheWishes) {
  const Heard heard({"setup a=224.255.0.25 p=5000 t=3 r=12.5 "});
  EXPECT_EQ(heard.session.wishes().group, "224.255.0.25");
  EXPECT_EQ(heard.session.wishes().port, 5000);
  EXPECT_EQ(heard.session.wishes().ttl, 3);
  EXPECT_EQ(heard.session.wishes().rate, 12.5);
  const Heard anew({"setup a=224.255.0.25 p=5000 t=3 r=12.5 setup r=7 "});
  EXPECT_EQ(anew.session.wishes().group, "");
  EXPECT_EQ(anew.session.wishes().port, 4150);
  EXPECT_EQ(anew.session.wishes().rate, 7.0);
}

TEST(BapSession, WishesThatMakeNoSenseAreNone) {
  const Heard heard({"setup p=99999 t=-4 r=nan "});
  EXPECT_EQ(heard.acts, "");
  EXPECT_EQ(heard.session.wishes().port, 4150);
  EXPECT_EQ(heard.session.wishes().ttl, 1);
  EXPECT_EQ(heard.session.wishes().rate, 0.0);
  EXPECT_EQ(Heard({"setup r=1e300 "}).session.wishes().rate, 0.0);
  EXPECT_EQ(Heard({"setup r=-5 "}).session.wishes().rate, 0.0);
}

TEST(BapSession, LetsGoWhoCannotBeUnderstood) {
  EXPECT_EQ(Heard({"GET / HTTP/1.1\r\n"}).acts, "x");
  EXPECT_EQ(Heard({"play f=before_setup "}).acts, "x");
  EXPECT_EQ(Heard({std::string(200, 'y'), std::string(200, 'y')}).acts, "x");
  EXPECT_EQ(Heard({std::string(200, ' '), std::string(2000, '\n')}).acts, "");
}

}  // namespace
}  // namespace telemime
