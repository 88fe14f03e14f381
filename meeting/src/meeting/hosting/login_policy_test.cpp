// SPDX-License-Identifier: Apache-2.0
#include "meeting/hosting/login_policy.h"

#include <gtest/gtest.h>

#include <set>

#include "telemime/core/random.h"

namespace telemime::meeting {
namespace {

const MeetingSecrets kSecrets{"speak-speak-speak", "watch-watch-watch", "chair-chair-chair",
                              "key-key-key-key-key", 1};

std::optional<LoginRequest> with(const std::string& invite, const std::string& rejoin = "",
                                 bool watch = false) {
  LoginRequest question;
  question.invite = invite.empty() ? std::nullopt : std::optional(invite);
  question.rejoin = rejoin.empty() ? std::nullopt : std::optional(rejoin);
  question.watch = watch;
  return question;
}

LoginRules rules(std::size_t most) {
  LoginRules rules;
  rules.most = most;
  return rules;
}

TEST(Question, IsReadFromJson) {
  const auto question =
      read_login_request(R"({"v":1,"invite":"abc","return":"1.s.x","watch":true,"more":[1]})");
  ASSERT_TRUE(question);
  EXPECT_EQ(question->invite, "abc");
  EXPECT_EQ(question->rejoin, "1.s.x");
  EXPECT_TRUE(question->watch);
  const auto bare = read_login_request(R"({"v":1,"invite":null})");
  ASSERT_TRUE(bare);
  EXPECT_FALSE(bare->invite || bare->rejoin || bare->watch);
}

TEST(Question, WhatIsNoneIsRefused) {
  for (const char* const bad :
       {"", "{", "[]", "1", "null", "{}", R"({"v":2,"invite":"a"})", R"({"v":"1"})", R"({"v":1,"invite":1})",
        R"({"v":1,"invite":""})", R"({"v":1,"return":["a"]})", R"({"v":1,"watch":1})",
        "{\"v\":1,\"invite\":\"\xff\"}", R"({"v":1,"more":[[[[1]]]]})"}) {
    EXPECT_FALSE(read_login_request(bad)) << bad;
  }
  EXPECT_FALSE(read_login_request(R"({"v":1,"invite":")" + std::string(501, 'a') + "\"}"));
  EXPECT_FALSE(read_login_request(std::string(4000, '[')));
}

TEST(Question, RandomBytesDoNoHarm) {
  Random random(1);
  const std::string good = R"({"v":1,"invite":"abc","return":"1.s.x","watch":true})";
  for (int i = 0; i < 20'000; ++i) {
    std::string text = good;
    for (int n = 0; n < 3; ++n) {
      text[static_cast<std::size_t>(random.uniform() * static_cast<double>(text.size()))] =
          static_cast<char>(static_cast<unsigned char>(random.uniform() * 256.0));
    }
    read_login_request(text);
  }
}

TEST(LoginPolicy, LinksGiveTheirRights) {
  LoginPolicy door(kSecrets, {});
  const LoginDecision speaker = door.enter(with(kSecrets.speak), "a", 0);
  EXPECT_EQ(speaker.answer, LoginResult::log_in);
  EXPECT_EQ(speaker.participant, "p01");
  EXPECT_FALSE(speaker.chair);
  EXPECT_TRUE(speaker.changed);
  const LoginDecision chair = door.enter(with(kSecrets.chair), "a", 0);
  EXPECT_EQ(chair.participant, "p02");
  EXPECT_TRUE(chair.chair);
  for (const auto& question :
       {with(kSecrets.watch), with(kSecrets.speak, "", true), with(kSecrets.chair, "", true)}) {
    const LoginDecision watcher = door.enter(question, "a", 0);
    EXPECT_EQ(watcher.answer, LoginResult::log_in);
    EXPECT_EQ(watcher.participant, "");
    EXPECT_FALSE(watcher.changed);
  }
  EXPECT_EQ(door.members().size(), 2U);
}

TEST(LoginPolicy, OthersStayOutside) {
  LoginPolicy door(kSecrets, {});
  const std::string mine = door.enter(with(kSecrets.speak), "a", 0).rejoin;
  for (const auto& question :
       {with("guess"), with(""), with("", "", true), with("", "1.s.guess"), with(kSecrets.key),
        with("guess", mine), with("", mine + "x"), with(kSecrets.speak + "x")}) {
    EXPECT_EQ(door.enter(question, "b", 0).answer, LoginResult::wrong_link);
  }
  EXPECT_EQ(door.enter(std::nullopt, "b", 0).answer, LoginResult::malformed);
  EXPECT_EQ(door.members().size(), 1U);
  LoginPolicy other({"s", "w", "c", "another key", 50}, {});
  EXPECT_EQ(other.enter(with("", mine), "b", 0).answer, LoginResult::wrong_link) << "after --new-links";
}

TEST(LoginPolicy, WhoComesBackIsWhoTheyWere) {
  LoginPolicy door(kSecrets, {});
  const LoginDecision first = door.enter(with(kSecrets.speak), "a", 0);
  door.enter(with(kSecrets.speak), "a", 0);
  for (const auto& question : {with("", first.rejoin), with(kSecrets.speak, first.rejoin)}) {
    const LoginDecision again = door.enter(question, "a", 1);
    EXPECT_EQ(again.participant, first.participant);
    EXPECT_EQ(again.rejoin, first.rejoin);
    EXPECT_FALSE(again.changed);
  }
  const LoginDecision risen = door.enter(with(kSecrets.chair, first.rejoin), "a", 2);
  EXPECT_EQ(risen.participant, first.participant);
  EXPECT_TRUE(risen.chair && risen.changed);
  EXPECT_TRUE(door.enter(with("", risen.rejoin), "a", 3).chair);
  EXPECT_EQ(door.members().size(), 2U);
}

TEST(LoginPolicy, NobodyGetsTheIdOfAnother) {
  LoginPolicy door(kSecrets, rules(3));
  std::set<std::string> ids;
  double now = 0;
  for (int i = 0; i < 50; ++i, now += 400) {
    const LoginDecision admission = door.enter(with(kSecrets.speak), "a", now);
    ASSERT_EQ(admission.answer, LoginResult::log_in);
    EXPECT_TRUE(ids.insert(admission.participant).second) << admission.participant;
    EXPECT_LE(door.members().size(), 3U);
    for (const std::string& gone : admission.freed) {
      EXPECT_FALSE(door.members().contains(gone));
    }
  }
  MeetingSecrets later = door.secrets();
  EXPECT_EQ(later.next, 51U) << "nor after the room was closed";
}

TEST(LoginPolicy, AFullRoomFreesWhoHasBeenAwayLongest) {
  LoginPolicy door(kSecrets, rules(2));
  const LoginDecision a = door.enter(with(kSecrets.speak), "a", 0);
  const LoginDecision b = door.enter(with(kSecrets.speak), "a", 10);
  EXPECT_EQ(door.enter(with(kSecrets.speak), "a", 20).answer, LoginResult::full) << "both have just come";
  EXPECT_EQ(door.enter(with(kSecrets.watch), "a", 20).answer, LoginResult::log_in) << "who only looks on may";
  door.seen(a.participant, true, 30);
  door.seen(b.participant, true, 30);
  EXPECT_EQ(door.enter(with(kSecrets.speak), "a", 5000).answer, LoginResult::full) << "both are here";
  door.seen(b.participant, false, 5000);
  EXPECT_EQ(door.enter(with(kSecrets.speak), "a", 5299).answer, LoginResult::full);
  const LoginDecision c = door.enter(with(kSecrets.speak), "a", 5300);
  EXPECT_EQ(c.answer, LoginResult::log_in);
  EXPECT_EQ(c.freed, std::vector<std::string>{b.participant});
  EXPECT_EQ(door.enter(with("", b.rejoin), "a", 5301).answer, LoginResult::full);
  door.seen(c.participant, true, 5301);
  door.seen(c.participant, false, 5302);
  const LoginDecision back = door.enter(with("", b.rejoin), "a", 6000);
  EXPECT_EQ(back.participant, b.participant) << "who was freed comes back as who they were";
  EXPECT_EQ(back.freed, std::vector<std::string>{c.participant});
}

TEST(LoginPolicy, ALockedRoomTakesOnlyThoseItKnowsAndChairs) {
  LoginPolicy door(kSecrets, {});
  const LoginDecision a = door.enter(with(kSecrets.speak), "a", 0);
  door.lock(true);
  EXPECT_EQ(door.enter(with(kSecrets.speak), "a", 1).answer, LoginResult::locked);
  EXPECT_EQ(door.enter(with(kSecrets.watch), "a", 1).answer, LoginResult::locked);
  EXPECT_EQ(door.enter(with("guess"), "a", 1).answer, LoginResult::wrong_link) << "a stranger learns nothing";
  EXPECT_EQ(door.enter(with(kSecrets.speak, a.rejoin), "a", 1).answer, LoginResult::log_in);
  EXPECT_EQ(door.enter(with(kSecrets.chair), "a", 1).answer, LoginResult::log_in);
  door.lock(false);
  EXPECT_EQ(door.enter(with(kSecrets.speak), "a", 1).answer, LoginResult::log_in);
}

TEST(LoginPolicy, WhoGuessesTooOftenWaits) {
  LoginRules strict;
  strict.rates.misses = 3;
  strict.rates.misses_per_second = 0.1;
  LoginPolicy door(kSecrets, strict);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(door.enter(with("guess"), "a", 0).answer, LoginResult::wrong_link);
  }
  EXPECT_EQ(door.enter(with("guess"), "a", 0).answer, LoginResult::too_many_tries);
  EXPECT_EQ(door.enter(std::nullopt, "a", 9).answer, LoginResult::too_many_tries);
  EXPECT_EQ(door.enter(with("guess"), "b", 9).answer, LoginResult::wrong_link) << "elsewhere";
  EXPECT_EQ(door.enter(with("guess"), "a", 11).answer, LoginResult::wrong_link);
}

TEST(LoginPolicy, WhoGuessesShutsNobodyOutBehindTheSameAddress) {
  LoginPolicy door(kSecrets, {});
  for (int i = 0; i < 1000; ++i) {
    door.enter(with("guess"), "proxy", 0);
  }
  EXPECT_EQ(door.enter(with(kSecrets.speak), "proxy", 0).answer, LoginResult::log_in);
}

TEST(LoginPolicy, WhoNeverComesKeepsNobodyOut) {
  LoginPolicy door(kSecrets, rules(3));
  const LoginDecision here = door.enter(with(kSecrets.speak), "a", 0);
  door.seen(here.participant, true, 1);
  const LoginDecision away = door.enter(with(kSecrets.speak), "a", 1);
  door.seen(away.participant, true, 1);
  door.seen(away.participant, false, 2);
  const LoginDecision lost = door.enter(with(kSecrets.speak), "a", 3);
  EXPECT_EQ(door.enter(with(kSecrets.speak), "a", 32).answer, LoginResult::full);
  const LoginDecision next = door.enter(with(kSecrets.speak), "a", 33);
  EXPECT_EQ(next.answer, LoginResult::log_in);
  EXPECT_EQ(next.freed, std::vector<std::string>{lost.participant}) << "not who was here a while ago";
}

TEST(RateLimit, TriesComeBackWithTime) {
  RateLimit limit(
      {.tries = 2, .tries_per_second = 0.5, .misses = 9, .misses_per_second = 1, .most_addresses = 9});
  EXPECT_TRUE(limit.allow("a", 0));
  EXPECT_TRUE(limit.allow("a", 0));
  EXPECT_FALSE(limit.allow("a", 1.9));
  EXPECT_TRUE(limit.allow("a", 2));
  EXPECT_TRUE(limit.allow("b", 2));
  EXPECT_TRUE(limit.allow("a", 1e9));
  EXPECT_TRUE(limit.allow("a", 1e9)) << "no more than at first come together";
  EXPECT_FALSE(limit.allow("a", 1e9));
}

TEST(RateLimit, OneNetworkOfIpv6IsOneAddress) {
  RateLimit limit(
      {.tries = 1, .tries_per_second = 0, .misses = 9, .misses_per_second = 1, .most_addresses = 9});
  EXPECT_TRUE(limit.allow("2001:db8::1", 0));
  EXPECT_FALSE(limit.allow("2001:db8::2:0:0:9", 0));
  EXPECT_TRUE(limit.allow("2001:db8:0:1::1", 0));
}

TEST(RateLimit, RemembersSoManyAddressesAtMost) {
  RateLimit limit(
      {.tries = 1, .tries_per_second = 0, .misses = 9, .misses_per_second = 1, .most_addresses = 2});
  EXPECT_TRUE(limit.allow("a", 0));
  EXPECT_TRUE(limit.allow("b", 1));
  EXPECT_TRUE(limit.allow("c", 2));
  EXPECT_FALSE(limit.allow("b", 3)) << "the newest two";
  EXPECT_TRUE(limit.allow("a", 4));
}

}  // namespace
}  // namespace telemime::meeting
