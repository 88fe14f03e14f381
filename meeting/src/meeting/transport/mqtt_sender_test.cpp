// SPDX-License-Identifier: Apache-2.0
// What needs no broker; tests/rooms has one.
#include "meeting/transport/mqtt_sender.h"

#include <gtest/gtest.h>

#include "meeting/transport/sender_kinds.h"
#include "telemime/core/errors.h"
#include "telemime/outputs/testing_motion.h"
#include "telemime/streaming/testing_receivers.h"

namespace telemime::meeting {
namespace {

using testing_receivers::comes_true;
using testing_receivers::ends_at_once;
using testing_receivers::free_port;
using testing_receivers::TcpListener;
using testing_receivers::TcpPeer;

std::unique_ptr<Sender> sender_to(std::uint16_t port, const std::string& scheme = "mqtt",
                                  const std::string& user = "") {
  return make_sender(scheme + "://" + user + "127.0.0.1:" + std::to_string(port) + "/home/studio",
                     kAllSenderKinds);
}

bool fails_with(const Sender& sender, const std::string& words) {
  const bool came = comes_true([&] {
    return sender.status().state == SenderState::failed && sender.status().words == words + "; trying again";
  });
  EXPECT_TRUE(came) << sender.status().words;
  return came;
}

TEST(MqttSender, NobodyThereIsToldInWords) {
  EXPECT_TRUE(fails_with(*sender_to(free_port()), "nobody listens there"));
  EXPECT_TRUE(fails_with(*sender_to(free_port(), "mqtts"), "nobody listens there"));
}

TEST(MqttSender, OtherServersAreTold) {
  TcpListener listener;
  const auto sender = sender_to(listener.port());
  TcpPeer peer = listener.accept();
  peer.send("HTTP/1.1 400 Bad Request\r\n\r\n");
  EXPECT_TRUE(fails_with(*sender, "it does not answer as an MQTT broker does"));
}

TEST(MqttSender, AnEarlyEndIsTold) {
  TcpListener listener;
  const auto sender = sender_to(listener.port());
  listener.accept().close();
  EXPECT_TRUE(fails_with(*sender, "it closed the connection without a word; mqtts:// may be meant"));
  TcpListener other;
  const auto encrypted = sender_to(other.port(), "mqtts");
  other.accept().close();
  EXPECT_TRUE(fails_with(*encrypted, "no TLS connection comes about; is TLS spoken at that port?"));
}

TEST(MqttSender, RefusalsAreToldInWords) {
  const auto answer = [](char code, const std::string& user, const std::string& words) {
    TcpListener listener;
    const auto sender = sender_to(listener.port(), "mqtt", user);
    TcpPeer peer = listener.accept();
    peer.send(std::string("\x20\x02\x00", 3) + code);
    EXPECT_TRUE(fails_with(*sender, words));
  };
  answer(1, "", "it does not speak MQTT 3.1.1");
  answer(2, "", "it does not accept our name");
  answer(3, "", "it takes nobody now");
  answer(4, "a:secret@", "it refuses the user or the password");
  answer(5, "a:secret@", "it refuses the user or the password");
  answer(5, "", "it wants a user and a password");
}

TEST(MqttSender, EndsAtOnceWhateverTheBrokerDoes) {
  const StreamHeader header = testing_motion::header();
  for (const char* const scheme : {"mqtt", "mqtts"}) {
    TcpListener silent;
    auto sender = sender_to(silent.port(), scheme);
    TcpPeer peer = silent.accept();
    sender->begin(header);
    EXPECT_TRUE(ends_at_once(std::move(sender)));
  }
  TcpListener mute;  // takes us, and says nothing more
  auto sender = sender_to(mute.port());
  TcpPeer peer = mute.accept();
  peer.send(std::string("\x20\x02\x00\x00", 4));
  sender->begin(header);
  EXPECT_TRUE(ends_at_once(std::move(sender)));
}

TEST(MqttSender, IsMadeAgainAndAgain) {
  const std::uint16_t port = free_port();
  for (int i = 0; i < 20; ++i) {
    const auto one = sender_to(port);
    const auto other = sender_to(port, "mqtts");
    EXPECT_EQ(one->status().sent, 0);
  }
}

TEST(MqttSender, OptionsAreChecked) {
  const auto refusal = [](const std::string& url) {
    try {
      make_sender(url, kAllSenderKinds);
    } catch (const Error& e) {
      EXPECT_EQ(e.kind(), ErrorKind::usage);
      return std::string(e.what());
    }
    return std::string();
  };
  const auto expect_words = [&](const std::string& url, const std::string& words) {
    EXPECT_NE(refusal(url).find(words), std::string::npos) << url << ": " << refusal(url);
  };
  expect_words("mqtt://localhost", "mqtt://localhost:1883/home/studio");
  expect_words("mqtt://localhost/home", "mqtt://localhost:1883/home/studio");
  expect_words("mqtt://localhost/home/studio/", "name a room");
  expect_words("mqtt://localhost/Home/studio", "name a room");
  expect_words("mqtt://localhost/home//studio", "name a room");
  expect_words("mqtt:///home/studio", "which computer");
  expect_words("mqtt://localhost:0/home/studio", "port");
  expect_words("mqtt://localhost/a/b?nam=Ana", "name, look, seat, participant, key, ca, mirror");
  expect_words("mqtt://localhost/a/b?name=" + std::string(41, 'x'), "40 characters");
  expect_words("mqtt://localhost/a/b?name=%ff", "UTF-8");
  expect_words("mqtt://localhost/a/b?look=../x", "look");
  expect_words("mqtt://localhost/a/b?seat=100", "0 to 99");
  expect_words("mqtt://localhost/a/b?participant=a.b", "participant");
  expect_words("mqtt://localhost/a/b?ca=x.pem", "mqtts://");
  expect_words("mqtts://localhost/a/b?ca=/none.pem", "/none.pem");
  expect_words("mqtt://localhost/a/b?key=/none.json", "/none.json");
  expect_words("mqtt://localhost/a/b?name=a@b", "%40");
  EXPECT_EQ(refusal("mqtt://localhost/a/b?name=J%C3%B6rg&look=robot&seat=0&participant=p07&mirror=1"), "");
}

}  // namespace
}  // namespace telemime::meeting
