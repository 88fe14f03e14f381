// SPDX-License-Identifier: Apache-2.0
// TLS: which certificates are trusted.
#include <gtest/gtest.h>

#include "authority.h"
#include "broker.h"
#include "checks.h"
#include "feeder.h"
#include "meeting/transport/senders.h"

namespace telemime::meeting::test_support {
namespace {

using testing_receivers::ends_at_once;

class Tls : public ::testing::Test {
 protected:
  Tls() { authority_.certify("broker", "DNS:localhost"); }
  std::string url(const Broker& broker, const std::string& host, const std::string& ca) const {
    return "mqtts://" + host + ":" + std::to_string(broker.port()) + "/home/studio" +
           (ca.empty() ? "" : "?ca=" + ca);
  }
  Authority authority_;
};

TEST_F(Tls, FramesArrive) {
  const Broker broker(authority_.file("broker.pem"), authority_.file("broker.key"));
  for (int run = 0; run < 3; ++run) {  // the library can be initialised again
    const auto sender = make_sender(url(broker, "localhost", authority_.file("ca.pem")), kAllSenderKinds);
    const Feeder feeder(*sender);
    ASSERT_TRUE(comes_true([&] { return sender->status().sent >= 10; })) << sender->status().words;
    EXPECT_EQ(sender->status().state, SenderState::sending);
  }
}

TEST_F(Tls, BrokerMayRestart) {
  Broker broker(authority_.file("broker.pem"), authority_.file("broker.key"));
  const auto sender = make_sender(url(broker, "localhost", authority_.file("ca.pem")), kAllSenderKinds);
  const Feeder feeder(*sender);
  ASSERT_TRUE(is_sending(*sender)) << sender->status().words;
  broker.kill();
  ASSERT_TRUE(fails_with(*sender, "no program is listening there")) << sender->status().words;
  broker.start();
  const std::int64_t sent = sender->status().sent;
  EXPECT_TRUE(comes_true([&] { return sender->status().sent >= sent + 10; })) << sender->status().words;
}

TEST_F(Tls, CertificateMayNameAnAddress) {
  authority_.certify("address", "IP:127.0.0.1");
  const Broker broker(authority_.file("address.pem"), authority_.file("address.key"));
  const auto sender = make_sender(url(broker, "127.0.0.1", authority_.file("ca.pem")), kAllSenderKinds);
  EXPECT_TRUE(is_sending(*sender)) << sender->status().words;
  const auto named = make_sender(url(broker, "localhost", authority_.file("ca.pem")), kAllSenderKinds);
  EXPECT_TRUE(fails_with(*named, R"(its certificate is not valid for "localhost")")) << named->status().words;
}

TEST_F(Tls, CertificateOfAnotherHostIsRejected) {
  const Broker broker(authority_.file("broker.pem"), authority_.file("broker.key"));
  const auto sender = make_sender(url(broker, "127.0.0.1", authority_.file("ca.pem")), kAllSenderKinds);
  EXPECT_TRUE(fails_with(*sender, R"(its certificate is not valid for "127.0.0.1")"))
      << sender->status().words;
  authority_.certify("elsewhere", "DNS:broker.example,DNS:*.localhost");
  const Broker other(authority_.file("elsewhere.pem"), authority_.file("elsewhere.key"));
  const auto named = make_sender(url(other, "localhost", authority_.file("ca.pem")), kAllSenderKinds);
  EXPECT_TRUE(fails_with(*named, R"(its certificate is not valid for "localhost")")) << named->status().words;
}

TEST_F(Tls, UntrustedAuthorityIsRejected) {
  const Broker broker(authority_.file("broker.pem"), authority_.file("broker.key"));
  const Authority other;
  const auto sender = make_sender(url(broker, "localhost", other.file("ca.pem")), kAllSenderKinds);
  EXPECT_TRUE(fails_with(*sender, "not signed by a trusted authority")) << sender->status().words;
  const auto system = make_sender(url(broker, "localhost", ""), kAllSenderKinds);
  EXPECT_TRUE(fails_with(*system, "not signed by a trusted authority")) << system->status().words;
  EXPECT_EQ(broker.log().find("New client connected"), std::string::npos) << broker.log();
}

TEST_F(Tls, ExpiredCertificateIsRejected) {
  authority_.certify("old", "DNS:localhost", "-1");
  const Broker broker(authority_.file("old.pem"), authority_.file("old.key"));
  const auto sender = make_sender(url(broker, "localhost", authority_.file("ca.pem")), kAllSenderKinds);
  EXPECT_TRUE(fails_with(*sender, "has expired")) << sender->status().words;
}

TEST_F(Tls, BothEndsNeedTls) {
  const Broker plain;
  const auto encrypted = make_sender(url(plain, "localhost", authority_.file("ca.pem")), kAllSenderKinds);
  EXPECT_TRUE(fails_with(*encrypted, kNoTls)) << encrypted->status().words;
  const Broker broker(authority_.file("broker.pem"), authority_.file("broker.key"));
  const auto open = make_sender(broker.url(), kAllSenderKinds);
  EXPECT_TRUE(comes_true([&] { return open->status().state == SenderState::failed; }));
  EXPECT_NE(open->status().words.find("it "), std::string::npos) << open->status().words;
}

TEST_F(Tls, EndsAtOnceWhileSending) {
  const Broker broker(authority_.file("broker.pem"), authority_.file("broker.key"));
  auto sender = make_sender(url(broker, "localhost", authority_.file("ca.pem")), kAllSenderKinds);
  sender->begin(testing_motion::header());
  ASSERT_TRUE(is_sending(*sender)) << sender->status().words;
  EXPECT_TRUE(ends_at_once(std::move(sender)));
  EXPECT_TRUE(comes_true([&] { return broker.log().find("Received DISCONNECT") != std::string::npos; }));
}

}  // namespace
}  // namespace telemime::meeting::test_support
