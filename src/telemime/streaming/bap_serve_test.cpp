// SPDX-License-Identifier: Apache-2.0
#include "telemime/streaming/bap_serve.h"

#include <gtest/gtest.h>

#include <vector>

#include "telemime/outputs/testing_motion.h"
#include "telemime/streaming/sender.h"
#include "telemime/streaming/testing_bap.h"
#include "telemime/streaming/testing_receivers.h"

namespace telemime {
namespace {

using testing_bap::BapText;
using testing_receivers::comes_true;
using testing_receivers::ends_at_once;
using testing_receivers::kTaken;
using testing_receivers::TcpPeer;
using testing_receivers::UdpReceiver;

/// A server on a free port, and the frames of a person for it.
class BapServe : public ::testing::Test {
 protected:
  BapServe() {
    sender_->begin(header_);
    EXPECT_TRUE(comes_true([&] { return sender_->status().state == SenderState::sending; }));
    const std::string words = sender_->status().words;
    const std::string before = "listens at 127.0.0.1:";
    EXPECT_EQ(words.substr(0, before.size()), before);
    port_ = static_cast<std::uint16_t>(std::stoi(words.substr(before.size())));
  }

  static std::string setup(std::uint16_t port, const std::string& rest = "r=100.00 ") {
    return "setup p=" + std::to_string(port) + " " + rest;
  }
  bool playing(std::int64_t count) const {
    return comes_true([&] { return sender_->status().receivers == count; });
  }
  /// Sends frames until one has come back; the datagram.
  std::string until_a_frame(UdpReceiver& receiver) {
    std::optional<std::string> datagram;
    EXPECT_TRUE(comes_true([&] {
      send();
      datagram = receiver.receive(20);
      return datagram.has_value();
    }));
    return datagram.value_or("");
  }
  void send() {
    MotionFrame frame = frames_[next_ % frames_.size()];
    frame.frame = next_;
    frame.time = static_cast<double>(next_++) / header_.fps;
    sender_->send(frame, kTaken);
  }

  StreamHeader header_ = testing_motion::header();
  std::vector<MotionFrame> frames_ = testing_motion::gesture(header_, 40);
  std::int64_t next_ = 0;
  std::unique_ptr<Sender> sender_ = make_sender("bap+serve://:0");
  std::uint16_t port_ = 0;
};

// As VREng's client does: no line breaks, and play may come in one piece with setup.
TEST_F(BapServe, PlaysToAClientByUdp) {
  UdpReceiver udp;
  TcpPeer client = TcpPeer::to(port_);
  ASSERT_TRUE(client.send(setup(udp.port()) + "play f=hi.bap"));
  const auto head = BapText::words(udp.receive().value_or(""));
  ASSERT_EQ(head.size(), 4U);
  EXPECT_EQ(head[0], "3.1");
  EXPECT_EQ(head[2], "25");
  EXPECT_EQ(head[3], "0");
  Pose pose;
  pose[Angle::l_shoulder_flexion] = -1.0;
  sender_->send(testing_motion::frame_of(header_.body, header_.camera, pose, 5, header_.fps), kTaken);
  const BapText frame = BapText::from_datagram(udp.receive().value_or(""));
  EXPECT_EQ(frame.number, 5);
  EXPECT_EQ(frame.values.at(32), 100000);
  EXPECT_EQ(frame.values.size(), 20U);
  EXPECT_TRUE(playing(1));
  EXPECT_TRUE(comes_true([&] { return sender_->status().sent == 1; }));
}

TEST_F(BapServe, NobodyPlaysAtFirst) {
  UdpReceiver udp;
  TcpPeer client = TcpPeer::to(port_);
  ASSERT_TRUE(client.send(setup(udp.port())));
  for (int t = 0; t < 5; ++t) {
    send();
  }
  EXPECT_FALSE(udp.receive(100).has_value());
  EXPECT_EQ(sender_->status().sent, 0);
  EXPECT_EQ(sender_->status().receivers, 0);
  EXPECT_NE(sender_->status().words.find("nobody plays"), std::string::npos);
}

TEST_F(BapServe, StopsPlaysAgainAndTearsDown) {
  UdpReceiver udp;
  TcpPeer client = TcpPeer::to(port_);
  ASSERT_TRUE(client.send(setup(udp.port()) + "play f=a\n"));
  EXPECT_EQ(BapText::words(udp.receive().value_or("")).size(), 4U);
  EXPECT_TRUE(playing(1));
  ASSERT_TRUE(client.send("stop"));
  EXPECT_TRUE(playing(0));
  ASSERT_TRUE(client.send("play f=b"));
  EXPECT_EQ(BapText::words(udp.receive().value_or("")).size(), 4U);
  EXPECT_EQ(BapText::from_datagram(until_a_frame(udp)).values.size(), 20U);
  ASSERT_TRUE(client.send("teardown"));
  EXPECT_TRUE(client.ends());
  EXPECT_TRUE(playing(0));
}

TEST_F(BapServe, TheClientsRateLimitsTheFrames) {
  UdpReceiver udp;
  TcpPeer client = TcpPeer::to(port_);
  ASSERT_TRUE(client.send(setup(udp.port(), "r=10.00 ") + "play f=a"));
  EXPECT_EQ(BapText::words(udp.receive().value_or("")).at(2), "10");
  std::vector<long> numbers;
  for (int t = 0; t < 50; ++t) {  // 2 s at 25 fps
    send();
    const std::int64_t done = next_;
    EXPECT_TRUE(comes_true([&] { return sender_->status().dropped == 0; }));
    const auto due = udp.receive(done % 5 == 1 || done % 5 == 4 ? testing_receivers::kPatience : 15);
    if (due) {
      numbers.push_back(BapText::from_datagram(*due).number);
    }
  }
  ASSERT_EQ(numbers.size(), 20U);  // ten a second, evenly: 0, 3, 5, 8, 10, ...
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    EXPECT_EQ(numbers[i], static_cast<long>(i / 2 * 5 + i % 2 * 3));
  }
}

TEST_F(BapServe, SendsToAMulticastGroupButToNoOtherAddress) {
  const std::string group = "239.255.41.50";
  UdpReceiver member(group);
  TcpPeer client = TcpPeer::to(port_);
  ASSERT_TRUE(client.send("setup a=" + group + " p=" + std::to_string(member.port()) + " t=1 r=25 play f=a"));
  EXPECT_EQ(BapText::words(member.receive().value_or("")).size(), 4U);
  EXPECT_EQ(BapText::from_datagram(until_a_frame(member)).values.size(), 20U);

  UdpReceiver victim;
  TcpPeer other = TcpPeer::to(port_);
  ASSERT_TRUE(other.send("setup a=127.0.0.2 p=" + std::to_string(victim.port()) + " r=25 play f=a"));
  ASSERT_TRUE(other.send(" teardown"));
  EXPECT_TRUE(other.ends());
  EXPECT_FALSE(victim.receive(50).has_value());
}

TEST_F(BapServe, GarbageEndsTheConnectionAlone) {
  UdpReceiver udp;
  TcpPeer good = TcpPeer::to(port_);
  ASSERT_TRUE(good.send(setup(udp.port()) + "play f=a"));
  EXPECT_TRUE(udp.receive().has_value());
  Random random(5);
  for (int n = 0; n < 200; ++n) {
    TcpPeer bad = TcpPeer::to(port_);
    std::string noise = n % 3 == 0 ? "setup p=99999 r=nan t=-5 a=.. " : "";
    const int length = n == 7 ? 200000 : 300;
    for (int i = 0; i < length; ++i) {
      noise += static_cast<char>(n == 7 ? 'x' : static_cast<int>(random.uniform(0.0, 255.9)));
    }
    bad.send(noise);
    if (n % 2 == 0) {
      bad.reset();
    } else {
      bad.shut_own_direction();
      EXPECT_TRUE(bad.ends()) << n;
    }
  }
  EXPECT_EQ(BapText::from_datagram(until_a_frame(udp)).values.size(), 20U);
  EXPECT_EQ(sender_->status().receivers, 1);
}

TEST_F(BapServe, ClientsThatVanishAreForgotten) {
  for (int n = 0; n < 40; ++n) {  // more than there is room for, one after another
    UdpReceiver udp;
    TcpPeer client = TcpPeer::to(port_);
    ASSERT_TRUE(client.send(setup(udp.port()) + "play f=a"));
    EXPECT_TRUE(udp.receive().has_value()) << n;
    if (n % 2 == 0) {
      client.reset();
    }
  }
  EXPECT_TRUE(playing(0));
}

TEST_F(BapServe, HasRoomForSomeClientsAlone) {
  std::vector<std::pair<TcpPeer, std::unique_ptr<UdpReceiver>>> clients;
  for (std::size_t n = 0; n < kMostBapClients; ++n) {
    clients.emplace_back(TcpPeer::to(port_), std::make_unique<UdpReceiver>());
    ASSERT_TRUE(clients.back().first.send(setup(clients.back().second->port()) + "play f=a"));
    EXPECT_TRUE(clients.back().second->receive().has_value());
  }
  TcpPeer late = TcpPeer::to(port_);
  EXPECT_TRUE(late.ends()) << "it is let go";
  clients.pop_back();
  TcpPeer next = TcpPeer::to(port_);
  UdpReceiver udp;
  EXPECT_TRUE(next.send(setup(udp.port()) + "play f=a"));
  EXPECT_TRUE(udp.receive().has_value());
}

TEST_F(BapServe, EndsAtOnceAndTellsTheClients) {
  UdpReceiver udp;
  TcpPeer client = TcpPeer::to(port_);
  ASSERT_TRUE(client.send(setup(udp.port()) + "play f=a"));
  EXPECT_TRUE(udp.receive().has_value());
  EXPECT_TRUE(ends_at_once(std::move(sender_)));
  EXPECT_EQ(udp.receive(), "") << "an empty datagram is the end of the stream";
  EXPECT_TRUE(client.ends());
}

TEST_F(BapServe, APortThatIsTakenIsReportedAndTakenLater) {
  const std::string url = "bap+serve://:" + std::to_string(port_);
  const auto second = make_sender(url);
  EXPECT_TRUE(comes_true([&] { return second->status().state == SenderState::failed; }));
  EXPECT_NE(second->status().words.find("another program uses that port; trying again"), std::string::npos);
  sender_.reset();
  EXPECT_TRUE(comes_true([&] { return second->status().state == SenderState::sending; }));
}

}  // namespace
}  // namespace telemime
