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
  LoginRequest request;
  request.invite = invite.empty() ? std::nullopt : std::optional(invite);
  request.rejoin = rejoin.empty() ? std::nullopt : std::optional(rejoin);
  request.watch = watch;
  return request;
}

LoginRules rules(std::size_t most) {
  LoginRules rules;
  rules.most = most;
  return rules;
}

TEST(LoginRequest, IsReadFromJson) {
  const auto request =
      read_login_request(R"({"v":1,"invite":"abc","return":"1.s.x","watch":true,"more":[1]})");
  ASSERT_TRUE(request);
  EXPECT_EQ(request->invite, "abc");
  EXPECT_EQ(request->rejoin, "1.s.x");
  EXPECT_TRUE(request->watch);
  const auto bare = read_login_request(R"({"v":1,"invite":null})");
  ASSERT_TRUE(bare);
  EXPECT_FALSE(bare->invite || bare->rejoin || bare->watch);
}

TEST(LoginRequest, InvalidRequestsAreRejected) {
  for (const char* const bad :
       {"", "{", "[]", "1", "null", "{}", R"({"v":2,"invite":"a"})", R"({"v":"1"})", R"({"v":1,"invite":1})",
        R"({"v":1,"invite":""})", R"({"v":1,"return":["a"]})", R"({"v":1,"watch":1})",
        "{\"v\":1,\"invite\":\"\xff\"}", R"({"v":1,"more":[[[[1]]]]})"}) {
    EXPECT_FALSE(read_login_request(bad)) << bad;
  }
  EXPECT_FALSE(read_login_request(R"({"v":1,"invite":")" + std::string(501, 'a') + "\"}"));
  EXPECT_FALSE(read_login_request(std::string(4000, '[')));
}

TEST(LoginRequest, RandomBytesAreHarmless) {
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
  LoginPolicy policy(kSecrets, {});
  const LoginDecision speaker = policy.log_in(with(kSecrets.speak), "a", 0);
  EXPECT_EQ(speaker.result, LoginResult::accepted);
  EXPECT_EQ(speaker.participant, "p01");
  EXPECT_FALSE(speaker.chair);
  const LoginDecision chair = policy.log_in(with(kSecrets.chair), "a", 0);
  EXPECT_EQ(chair.participant, "p02");
  EXPECT_TRUE(chair.chair);
  for (const auto& request :
       {with(kSecrets.watch), with(kSecrets.speak, "", true), with(kSecrets.chair, "", true)}) {
    const LoginDecision watcher = policy.log_in(request, "a", 0);
    EXPECT_EQ(watcher.result, LoginResult::accepted);
    EXPECT_EQ(watcher.participant, "");
  }
  EXPECT_EQ(policy.members().size(), 2U);
}

TEST(LoginPolicy, OtherLinksAreRejected) {
  LoginPolicy policy(kSecrets, {});
  const std::string mine = policy.log_in(with(kSecrets.speak), "a", 0).rejoin;
  for (const auto& request :
       {with("guess"), with(""), with("", "", true), with("", "1.s.guess"), with(kSecrets.key),
        with("guess", mine), with("", mine + "x"), with(kSecrets.speak + "x")}) {
    EXPECT_EQ(policy.log_in(request, "b", 0).result, LoginResult::wrong_link);
  }
  EXPECT_EQ(policy.log_in(std::nullopt, "b", 0).result, LoginResult::malformed);
  EXPECT_EQ(policy.members().size(), 1U);
  LoginPolicy other({"s", "w", "c", "another key", 50}, {});
  EXPECT_EQ(other.log_in(with("", mine), "b", 0).result, LoginResult::wrong_link) << "after --new-links";
}

TEST(LoginPolicy, RejoiningGivesTheSameParticipant) {
  LoginPolicy policy(kSecrets, {});
  const LoginDecision first = policy.log_in(with(kSecrets.speak), "a", 0);
  policy.log_in(with(kSecrets.speak), "a", 0);
  for (const auto& request : {with("", first.rejoin), with(kSecrets.speak, first.rejoin)}) {
    const LoginDecision again = policy.log_in(request, "a", 1);
    EXPECT_EQ(again.participant, first.participant);
    EXPECT_EQ(again.rejoin, first.rejoin);
  }
  const LoginDecision risen = policy.log_in(with(kSecrets.chair, first.rejoin), "a", 2);
  EXPECT_EQ(risen.participant, first.participant);
  EXPECT_TRUE(risen.chair);
  EXPECT_TRUE(policy.log_in(with("", risen.rejoin), "a", 3).chair);
  EXPECT_EQ(policy.members().size(), 2U);
}

TEST(LoginPolicy, IdsAreNeverReused) {
  LoginPolicy policy(kSecrets, rules(3));
  std::set<std::string> ids;
  double now = 0;
  for (int i = 0; i < 50; ++i, now += 400) {
    const LoginDecision admission = policy.log_in(with(kSecrets.speak), "a", now);
    ASSERT_EQ(admission.result, LoginResult::accepted);
    EXPECT_TRUE(ids.insert(admission.participant).second) << admission.participant;
    EXPECT_LE(policy.members().size(), 3U);
    for (const std::string& gone : admission.freed) {
      EXPECT_FALSE(policy.members().contains(gone));
    }
  }
  MeetingSecrets later = policy.secrets();
  EXPECT_EQ(later.next, 51U) << "not even after the meeting was closed";
}

TEST(LoginPolicy, FullMeetingFreesTheLongestAbsent) {
  LoginPolicy policy(kSecrets, rules(2));
  const LoginDecision a = policy.log_in(with(kSecrets.speak), "a", 0);
  const LoginDecision b = policy.log_in(with(kSecrets.speak), "a", 10);
  EXPECT_EQ(policy.log_in(with(kSecrets.speak), "a", 20).result, LoginResult::full)
      << "both have just joined";
  EXPECT_EQ(policy.log_in(with(kSecrets.watch), "a", 20).result, LoginResult::accepted)
      << "watching is possible";
  policy.set_presence(a.participant, true, 30);
  policy.set_presence(b.participant, true, 30);
  EXPECT_EQ(policy.log_in(with(kSecrets.speak), "a", 5000).result, LoginResult::full) << "both are present";
  policy.set_presence(b.participant, false, 5000);
  EXPECT_EQ(policy.log_in(with(kSecrets.speak), "a", 5299).result, LoginResult::full);
  const LoginDecision c = policy.log_in(with(kSecrets.speak), "a", 5300);
  EXPECT_EQ(c.result, LoginResult::accepted);
  EXPECT_EQ(c.freed, std::vector<std::string>{b.participant});
  EXPECT_EQ(policy.log_in(with("", b.rejoin), "a", 5301).result, LoginResult::full);
  policy.set_presence(c.participant, true, 5301);
  policy.set_presence(c.participant, false, 5302);
  const LoginDecision back = policy.log_in(with("", b.rejoin), "a", 6000);
  EXPECT_EQ(back.participant, b.participant) << "removed participants can rejoin";
  EXPECT_EQ(back.freed, std::vector<std::string>{c.participant});
}

TEST(LoginPolicy, LockedMeetingAcceptsMembersAndChairs) {
  LoginPolicy policy(kSecrets, {});
  const LoginDecision a = policy.log_in(with(kSecrets.speak), "a", 0);
  policy.lock(true);
  EXPECT_EQ(policy.log_in(with(kSecrets.speak), "a", 1).result, LoginResult::locked);
  EXPECT_EQ(policy.log_in(with(kSecrets.watch), "a", 1).result, LoginResult::locked);
  EXPECT_EQ(policy.log_in(with("guess"), "a", 1).result, LoginResult::wrong_link)
      << "a wrong link reveals nothing";
  EXPECT_EQ(policy.log_in(with(kSecrets.speak, a.rejoin), "a", 1).result, LoginResult::accepted);
  EXPECT_EQ(policy.log_in(with(kSecrets.chair), "a", 1).result, LoginResult::accepted);
  policy.lock(false);
  EXPECT_EQ(policy.log_in(with(kSecrets.speak), "a", 1).result, LoginResult::accepted);
}

TEST(LoginPolicy, GuessingIsLimited) {
  LoginRules strict;
  strict.rate_limit.failures = 3;
  strict.rate_limit.failures_per_second = 0.1;
  LoginPolicy policy(kSecrets, strict);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(policy.log_in(with("guess"), "a", 0).result, LoginResult::wrong_link);
  }
  EXPECT_EQ(policy.log_in(with("guess"), "a", 0).result, LoginResult::too_many_attempts);
  EXPECT_EQ(policy.log_in(std::nullopt, "a", 9).result, LoginResult::too_many_attempts);
  EXPECT_EQ(policy.log_in(with("guess"), "b", 9).result, LoginResult::wrong_link) << "elsewhere";
  EXPECT_EQ(policy.log_in(with("guess"), "a", 11).result, LoginResult::wrong_link);
}

TEST(LoginPolicy, GuessingLocksNobodyElseOut) {
  LoginPolicy policy(kSecrets, {});
  for (int i = 0; i < 1000; ++i) {
    policy.log_in(with("guess"), "proxy", 0);
  }
  EXPECT_EQ(policy.log_in(with(kSecrets.speak), "proxy", 0).result, LoginResult::accepted);
}

TEST(LoginPolicy, NewcomersWhoNeverJoinLoseTheirSeat) {
  LoginPolicy policy(kSecrets, rules(3));
  const LoginDecision here = policy.log_in(with(kSecrets.speak), "a", 0);
  policy.set_presence(here.participant, true, 1);
  const LoginDecision away = policy.log_in(with(kSecrets.speak), "a", 1);
  policy.set_presence(away.participant, true, 1);
  policy.set_presence(away.participant, false, 2);
  const LoginDecision lost = policy.log_in(with(kSecrets.speak), "a", 3);
  EXPECT_EQ(policy.log_in(with(kSecrets.speak), "a", 32).result, LoginResult::full);
  const LoginDecision next = policy.log_in(with(kSecrets.speak), "a", 33);
  EXPECT_EQ(next.result, LoginResult::accepted);
  EXPECT_EQ(next.freed, std::vector<std::string>{lost.participant}) << "not somebody who was present";
}

TEST(RateLimit, AttemptsAreAddedAgainWithTime) {
  RateLimit limit({.attempts = 2,
                   .attempts_per_second = 0.5,
                   .failures = 9,
                   .failures_per_second = 1,
                   .most_addresses = 9});
  EXPECT_TRUE(limit.allow("a", 0));
  EXPECT_TRUE(limit.allow("a", 0));
  EXPECT_FALSE(limit.allow("a", 1.9));
  EXPECT_TRUE(limit.allow("a", 2));
  EXPECT_TRUE(limit.allow("b", 2));
  EXPECT_TRUE(limit.allow("a", 1e9));
  EXPECT_TRUE(limit.allow("a", 1e9)) << "never more than at the start";
  EXPECT_FALSE(limit.allow("a", 1e9));
}

TEST(RateLimit, Ipv6NetworkIsOneAddress) {
  RateLimit limit({.attempts = 1,
                   .attempts_per_second = 0,
                   .failures = 9,
                   .failures_per_second = 1,
                   .most_addresses = 9});
  EXPECT_TRUE(limit.allow("2001:db8::1", 0));
  EXPECT_FALSE(limit.allow("2001:db8::2:0:0:9", 0));
  EXPECT_TRUE(limit.allow("2001:db8:0:1::1", 0));
}

TEST(RateLimit, NumberOfAddressesIsBounded) {
  RateLimit limit({.attempts = 1,
                   .attempts_per_second = 0,
                   .failures = 9,
                   .failures_per_second = 1,
                   .most_addresses = 2});
  EXPECT_TRUE(limit.allow("a", 0));
  EXPECT_TRUE(limit.allow("b", 1));
  EXPECT_TRUE(limit.allow("c", 2));
  EXPECT_FALSE(limit.allow("b", 3)) << "the newest two";
  EXPECT_TRUE(limit.allow("a", 4));
}

}  // namespace
}  // namespace telemime::meeting
