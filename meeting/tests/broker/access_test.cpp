// SPDX-License-Identifier: Apache-2.0
// Who may take part, and what a broker's refusal is called.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdlib>
#include <fstream>

#include "broker.h"
#include "feeder.h"
#include "meeting/transport/senders.h"
#include "meeting/transport/senders.h"
#include "subscriber.h"
#include "telemime/core/scratch_folder.h"
#include "telemime/streaming/testing_receivers.h"

namespace telemime::meeting::test_support {
namespace {

using testing_receivers::comes_true;

const std::string kReads = "topic read r/home/studio/#\n";

std::string may_publish_as(const std::string& participant) {
  return kReads + "topic readwrite r/home/studio/p/" + participant + "/#\n";
}

class Access : public ::testing::Test {
 protected:
  bool fails_with(const Sender& sender, const std::string& words) const {
    return comes_true([&] {
      const SenderStatus status = sender.status();
      return status.state == SenderState::failed && status.words == words + "; trying again";
    });
  }
  bool hears(const std::string& participant) const {
    return comes_true([&] { return !ear_.frames(participant).empty(); });
  }
  Broker broker_{{{"studio.p01", "secret", may_publish_as("p01")},
                  {"studio.p02", "secret", kReads},
                  {"studio.p03", "secret", "topic write r/home/studio/p/p03/#\n"},
                  {"studio.watch", "secret", kReads}}};
  Subscriber ear_{broker_.port(), "studio.watch", "secret"};
};

TEST_F(Access, AnAccountTakesPartUnderItsName) {
  const auto sender = make_sender(broker_.url("studio.p01:secret@"), kAllSenderKinds);
  const Feeder feeder(*sender);
  EXPECT_TRUE(hears("p01")) << sender->status().words;
  EXPECT_EQ(ear_.json("p/p01/state").at("name"), "p01");
  EXPECT_EQ(sender->status().words, "");
  EXPECT_EQ(sender->status().url, broker_.url("studio.p01@"));
}

TEST_F(Access, AKeyFileDoesTheSame) {
  const ScratchFolder folder;
  std::ofstream(folder.file("key.json")) << R"({"user":"studio.p01","password":"secret"})";
  ASSERT_EQ(::chmod(folder.file("key.json").c_str(), 0600), 0);
  const std::string url = broker_.url() + "?key=" + folder.file("key.json");
  {
    const auto sender = make_sender(url, kAllSenderKinds);
    const Feeder feeder(*sender);
    EXPECT_TRUE(hears("p01")) << sender->status().words;
    EXPECT_EQ(sender->status().words, "");
  }
  ASSERT_EQ(::chmod(folder.file("key.json").c_str(), 0644), 0);
  const auto sender = make_sender(url, kAllSenderKinds);
  EXPECT_TRUE(comes_true([&] { return sender->status().state == SenderState::sending; }));
  EXPECT_NE(sender->status().words.find("chmod 600"), std::string::npos) << sender->status().words;
}

TEST_F(Access, TheEnvironmentDoesTheSame) {
  ASSERT_EQ(::setenv(kMeetingKeyVariable, "studio.p01:secret", 1), 0);
  const auto sender = make_sender(broker_.url(), kAllSenderKinds);
  ASSERT_EQ(::unsetenv(kMeetingKeyVariable), 0);
  const Feeder feeder(*sender);
  EXPECT_TRUE(hears("p01")) << sender->status().words;
}

TEST_F(Access, AWrongPasswordIsTold) {
  const auto sender = make_sender(broker_.url("studio.p01:guess@"), kAllSenderKinds);
  EXPECT_TRUE(fails_with(*sender, "it refuses the user or the password")) << sender->status().words;
  const auto stranger = make_sender(broker_.url(), kAllSenderKinds);
  EXPECT_TRUE(fails_with(*stranger, "it wants a user and a password")) << stranger->status().words;
}

TEST_F(Access, WhoMayNotPublishIsTold) {
  const auto sender = make_sender(broker_.url("studio.p02:secret@"), kAllSenderKinds);
  const Feeder feeder(*sender);
  EXPECT_TRUE(
      fails_with(*sender, "it lets nothing pass that we say as \"p02\": the account may not publish there"))
      << sender->status().words;
  EXPECT_EQ(sender->status().sent, 0);
  EXPECT_TRUE(ear_.frames("p02").empty());
  const auto other = make_sender(broker_.url("studio.p01:secret@") + "?participant=p02", kAllSenderKinds);
  EXPECT_TRUE(
      fails_with(*other, "it lets nothing pass that we say as \"p02\": the account may not publish there"))
      << other->status().words;
}

TEST_F(Access, WhoMayNotReadTheRoomIsTold) {
  const auto sender = make_sender(broker_.url("studio.p03:secret@"), kAllSenderKinds);
  ASSERT_TRUE(comes_true([&] { return sender->status().state == SenderState::failed; }));
  EXPECT_NE(sender->status().words.find("account"), std::string::npos) << sender->status().words;
}

TEST_F(Access, NoPasswordIsEverShown) {
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
