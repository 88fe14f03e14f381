// SPDX-License-Identifier: Apache-2.0
// Accounts and their rights, and the messages when a broker refuses.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdlib>
#include <fstream>

#include "broker.h"
#include "checks.h"
#include "feeder.h"
#include "meeting/transport/senders.h"
#include "telemime/core/scratch_folder.h"
#include "telemime/streaming/testing_receivers.h"

namespace telemime::meeting::test_support {
namespace {

const std::string kReads = "topic read r/home/studio/#\n";

std::string may_publish_as(const std::string& participant) {
  return kReads + "topic readwrite r/home/studio/p/" + participant + "/#\n";
}

class Access : public ::testing::Test {
 protected:
  Broker broker_{{{"studio.p01", "secret", may_publish_as("p01")},
                  {"studio.p02", "secret", kReads},
                  {"studio.p03", "secret", "topic write r/home/studio/p/p03/#\n"},
                  {"studio.watch", "secret", kReads}}};
  Subscriber subscriber_{broker_.port(), "studio.watch", "secret"};
};

TEST_F(Access, AccountTakesPartUnderItsName) {
  const auto sender = make_sender(broker_.url("studio.p01:secret@"), kAllSenderKinds);
  const Feeder feeder(*sender);
  EXPECT_TRUE(has_frames(subscriber_, "p01", 1)) << sender->status().words;
  EXPECT_EQ(subscriber_.json("p/p01/state").at("name"), "p01");
  EXPECT_EQ(sender->status().words, "");
  EXPECT_EQ(sender->status().url, broker_.url("studio.p01@"));
}

TEST_F(Access, KeyFileHasTheAccount) {
  const ScratchFolder folder;
  std::ofstream(folder.file("key.json")) << R"({"user":"studio.p01","password":"secret"})";
  ASSERT_EQ(::chmod(folder.file("key.json").c_str(), 0600), 0);
  const std::string url = broker_.url() + "?key=" + folder.file("key.json");
  {
    const auto sender = make_sender(url, kAllSenderKinds);
    const Feeder feeder(*sender);
    EXPECT_TRUE(has_frames(subscriber_, "p01", 1)) << sender->status().words;
    EXPECT_EQ(sender->status().words, "");
  }
  ASSERT_EQ(::chmod(folder.file("key.json").c_str(), 0644), 0);
  const auto sender = make_sender(url, kAllSenderKinds);
  EXPECT_TRUE(comes_true([&] { return sender->status().state == SenderState::sending; }));
  EXPECT_NE(sender->status().words.find("chmod 600"), std::string::npos) << sender->status().words;
}

TEST_F(Access, EnvironmentHasTheAccount) {
  ASSERT_EQ(::setenv(kKeyVariable, "studio.p01:secret", 1), 0);
  const auto sender = make_sender(broker_.url(), kAllSenderKinds);
  ASSERT_EQ(::unsetenv(kKeyVariable), 0);
  const Feeder feeder(*sender);
  EXPECT_TRUE(has_frames(subscriber_, "p01", 1)) << sender->status().words;
}

TEST_F(Access, WrongPasswordIsReported) {
  const auto sender = make_sender(broker_.url("studio.p01:guess@"), kAllSenderKinds);
  EXPECT_TRUE(fails_with(*sender, "it rejects the user name or password")) << sender->status().words;
  const auto stranger = make_sender(broker_.url(), kAllSenderKinds);
  EXPECT_TRUE(fails_with(*stranger, "it requires a user name and password")) << stranger->status().words;
}

TEST_F(Access, ForbiddenPublishingIsReported) {
  const auto sender = make_sender(broker_.url("studio.p02:secret@"), kAllSenderKinds);
  const Feeder feeder(*sender);
  EXPECT_TRUE(fails_with(*sender, "the account may not publish as \"p02\"")) << sender->status().words;
  EXPECT_EQ(sender->status().sent, 0);
  EXPECT_TRUE(subscriber_.frames("p02").empty());
  const auto other = make_sender(broker_.url("studio.p01:secret@") + "?participant=p02", kAllSenderKinds);
  EXPECT_TRUE(fails_with(*other, "the account may not publish as \"p02\"")) << other->status().words;
}

TEST_F(Access, ForbiddenReadingIsReported) {
  const auto sender = make_sender(broker_.url("studio.p03:secret@"), kAllSenderKinds);
  ASSERT_TRUE(comes_true([&] { return sender->status().state == SenderState::failed; }));
  EXPECT_NE(sender->status().words.find("account"), std::string::npos) << sender->status().words;
}

TEST_F(Access, PasswordsAreNeverShown) {
  std::vector<std::unique_ptr<Sender>> senders;
  senders.push_back(make_sender(broker_.url("studio.p01:secret@"), kAllSenderKinds));
  senders.push_back(make_sender(broker_.url("studio.p02:secret@"), kAllSenderKinds));
  senders.push_back(make_sender(broker_.url("studio.p01:secretguess@"), kAllSenderKinds));
  for (const auto& sender : senders) {
    ASSERT_TRUE(comes_true([&] { return sender->status().state != SenderState::connecting; }));
    EXPECT_EQ((sender->status().url + sender->status().words).find("secret"), std::string::npos);
  }
}

}  // namespace
}  // namespace telemime::meeting::test_support
