// SPDX-License-Identifier: Apache-2.0
#include "meeting/hosting/accounts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "meeting/hosting/crypto.h"

namespace telemime::meeting {
namespace {

const MeetingAddress kMeeting{"home", "blue"};

TEST(Crypto, Base64IsThatOfRfc4648) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64url("\xfb\xff"), "-_8");
  EXPECT_EQ(base64url(std::string(2, '\0')), "AAA");
}

// RFC 4231, test case 2.
TEST(Crypto, SignatureIsHmacSha256) {
  EXPECT_EQ(signature("Jefe", "what do ya want for nothing?"), "W9zBRr9gdU5qBCQmCJV1x1oAPwidJzmDnexYuWTsOEM");
}

TEST(Crypto, SecretsDifferAndFitIntoUrls) {
  std::set<std::string> all;
  for (int i = 0; i < 100; ++i) {
    const std::string secret = random_secret();
    EXPECT_EQ(secret.size(), 32U);
    EXPECT_EQ(secret.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_"),
              std::string::npos)
        << secret;
    all.insert(secret);
  }
  EXPECT_EQ(all.size(), 100U);
}

TEST(Crypto, SameSecretComparesEverything) {
  EXPECT_TRUE(same_secret("", ""));
  EXPECT_TRUE(same_secret("abc", "abc"));
  EXPECT_FALSE(same_secret("abc", "abd"));
  EXPECT_FALSE(same_secret("abc", "abcd"));
  EXPECT_FALSE(same_secret("abc", ""));
}

TEST(Accounts, IdsAreSegmentsInOrder) {
  EXPECT_EQ(participant_id(1), "p01");
  EXPECT_EQ(participant_id(10), "p10");
  EXPECT_EQ(participant_id(1234), "p1234");
  EXPECT_TRUE(is_topic_segment(participant_id(1'000'000'000)));
}

TEST(Accounts, RejoinTokenIsReadAsWritten) {
  for (const unsigned number : {1U, 9U, 10U, 12345U, 999'999'999U}) {
    for (const bool chair : {false, true}) {
      const std::string text = write_rejoin_token("key", {number, chair});
      const auto way = read_rejoin_token("key", text);
      ASSERT_TRUE(way) << text;
      EXPECT_EQ(way->number, number);
      EXPECT_EQ(way->chair, chair);
      EXPECT_LE(text.size(), 500U);
    }
  }
}

TEST(Accounts, ChangedRejoinTokenIsRejected) {
  const std::string good = write_rejoin_token("key", {12, false});
  for (std::size_t i = 0; i < good.size(); ++i) {
    std::string bad = good;
    bad[i] = bad[i] == 'A' ? 'B' : 'A';
    EXPECT_FALSE(read_rejoin_token("key", bad)) << bad;
    EXPECT_FALSE(read_rejoin_token("key", good.substr(0, i))) << i;
  }
  EXPECT_FALSE(read_rejoin_token("other", good));
  EXPECT_FALSE(read_rejoin_token("key", good + "A"));
  EXPECT_FALSE(read_rejoin_token("key", "13" + good.substr(2))) << "another participant";
  EXPECT_FALSE(read_rejoin_token("key", "12.c" + good.substr(4))) << "more rights";
  EXPECT_FALSE(read_rejoin_token("key", "012" + good.substr(2))) << "one text for one way";
}

TEST(Accounts, PasswordsBelongToOneParticipant) {
  std::set<std::string> all;
  for (const char* const key : {"a", "b"}) {
    for (unsigned number = 1; number < 100; ++number) {
      all.insert(participant_password(key, participant_id(number)));
    }
    all.insert(watcher_account(kMeeting, key).password);
  }
  EXPECT_EQ(all.size(), 200U);
  EXPECT_EQ(participant_password("a", "p01"), participant_password("a", "p01"));
}

TEST(Accounts, ParticipantsWriteTheirOwnTopicsOnly) {
  const BrokerAccount account = participant_account(kMeeting, "key", "p07", false);
  EXPECT_EQ(account.user, "blue.p07");
  EXPECT_EQ(account.read, std::vector<std::string>{"r/home/blue/#"});
  for (const std::string& topic : account.write) {
    EXPECT_TRUE(topic.starts_with("r/home/blue/p/p07/")) << topic;
    EXPECT_EQ(topic.find_first_of("#+"), std::string::npos) << topic;
  }
  const auto may = [](const BrokerAccount& a, const std::string& topic) {
    return std::find(a.write.begin(), a.write.end(), topic) != a.write.end();
  };
  for (const char* const what : {"pose", "state", "presence", "chat", "board/0", "board/63"}) {
    EXPECT_TRUE(may(account, std::string("r/home/blue/p/p07/") + what)) << what;
  }
  EXPECT_FALSE(may(account, "r/home/blue/room"));
  EXPECT_TRUE(may(participant_account(kMeeting, "key", "p07", true), "r/home/blue/room"));
  EXPECT_TRUE(watcher_account(kMeeting, "key").write.empty());
  EXPECT_EQ(participant_of_user(kMeeting, account.user), "p07");
}

}  // namespace
}  // namespace telemime::meeting
