// SPDX-License-Identifier: Apache-2.0
// Keys and senders without a broker; tests/broker has one.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>

#include "meeting/protocol/testing.h"
#include "meeting/transport/senders.h"
#include "telemime/core/scratch_folder.h"
#include "telemime/outputs/testing_motion.h"
#include "telemime/streaming/testing_receivers.h"

namespace telemime::meeting {
namespace {

SendUrl parsed(const std::string& url) {
  return parse_url(url, "mqtt://h/a/b", UrlCredentials::accepted);
}

class BrokerKeys : public ::testing::Test {
 protected:
  std::string file(const std::string& content, mode_t mode = 0600) const {
    std::string path = folder_.file("key.json");
    std::ofstream(path) << content;
    EXPECT_EQ(::chmod(path.c_str(), mode), 0);
    return path;
  }
  static std::string refusal(const std::string& path) {
    return error_of([&] { read_key_file(path); }, ErrorKind::usage);
  }
  ScratchFolder folder_;
};

TEST_F(BrokerKeys, FileHasUserAndPassword) {
  const BrokerKey key = read_key_file(file(R"({"user":"studio.p01","password":"s\u00e4cret","more":1})"));
  EXPECT_EQ(key.user, "studio.p01");
  EXPECT_EQ(key.password,
            "s\xc3\xa4"
            "cret");
  EXPECT_EQ(key.warning, "");
}

TEST_F(BrokerKeys, FileThatOthersCanReadGivesAWarning) {
  for (const mode_t mode : {0640, 0604, 0660, 0644}) {
    const std::string path = file(R"({"user":"u","password":"secret"})", mode);
    const std::string warning = read_key_file(path).warning;
    EXPECT_NE(warning.find("chmod 600 " + path), std::string::npos) << warning;
    EXPECT_EQ(warning.find("secret"), std::string::npos);
  }
  EXPECT_EQ(read_key_file(file(R"({"user":"u","password":"secret"})", 0400)).warning, "");
}

TEST_F(BrokerKeys, OtherFilesAreRejectedWithoutAQuote) {
  for (const std::string& content :
       {std::string(), std::string("secret"), std::string(R"({"user":"u"})"),
        std::string(R"({"password":"secret"})"), std::string(R"({"user":"","password":"secret"})"),
        std::string(R"({"user":"u","password":7})"), std::string(R"(["u","secret"])"),
        std::string("{\"user\":\"u\",\"password\":\"secret\\u0000\"}"),
        std::string("{\"user\":\"u\",\"password\":\"secret\xff\"}"),
        R"({"user":"u","password":"secret","x":")" + std::string(5000, 'x') + "\"}",
        R"({"user":"u","password":")" + std::string(300, 'x') + "\"}"}) {
    const std::string text = refusal(file(content));
    EXPECT_NE(text.find("key.json"), std::string::npos) << content;
    EXPECT_EQ(text.find("secret"), std::string::npos) << text;
  }
  EXPECT_NE(refusal(folder_.file("none")).find("none"), std::string::npos);
  EXPECT_NE(refusal(folder_.path().string()), "");
  EXPECT_NE(refusal("/dev/zero").find("it is not a regular file"), std::string::npos);
  const std::string pipe = folder_.file("pipe");
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_NE(refusal(pipe).find("it is not a regular file"), std::string::npos)
      << "without waiting for a writer";
}

TEST_F(BrokerKeys, UrlThenFileThenEnvironment) {
  const std::string path = file(R"({"user":"filed","password":"f"})");
  const auto user = [](const std::string& url, const char* environment) {
    const auto key = key_of(parsed(url), environment);
    return key ? key->user + ":" + key->password : "";
  };
  EXPECT_EQ(user("mqtt://h/a/b", nullptr), "");
  EXPECT_EQ(user("mqtt://h/a/b", ""), "");
  EXPECT_EQ(user("mqtt://h/a/b", "env:e:e"), "env:e:e");
  EXPECT_EQ(user("mqtt://h/a/b?key=" + path, "env:e"), "filed:f");
  EXPECT_EQ(user("mqtt://url:u@h/a/b?key=" + path, "env:e"), "url:u");
  EXPECT_EQ(user("mqtt://env@h/a/b", "env:e"), "env:e");
  EXPECT_EQ(user("mqtt://filed@h/a/b?key=" + path, "env:e"), "filed:f");
}

TEST_F(BrokerKeys, UserWithoutAPasswordIsRejected) {
  for (const char* const environment :
       {static_cast<const char*>(nullptr), "other:secret", "secret", ":secret"}) {
    const std::string text = error_of([&] { key_of(parsed("mqtt://studio.p01@h/a/b"), environment); });
    EXPECT_TRUE(contains(text, kKeyVariable)) << text;
    EXPECT_FALSE(contains(text, "secret")) << text;
  }
  EXPECT_THROW(key_of(parsed("mqtt://h/a/b"), "secret"), Error);
  EXPECT_THROW(key_of(parsed("mqtt://h/a/b?key=%"), nullptr), Error);
}

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

bool fails_with(const Sender& sender, const std::string& text) {
  const bool came = comes_true([&] {
    return sender.status().state == SenderState::failed && sender.status().words == text + "; trying again";
  });
  EXPECT_TRUE(came) << sender.status().words;
  return came;
}

TEST(MqttSender, RefusedConnectionIsReported) {
  EXPECT_TRUE(fails_with(*sender_to(free_port()), "no program is listening there"));
  EXPECT_TRUE(fails_with(*sender_to(free_port(), "mqtts"), "no program is listening there"));
}

TEST(MqttSender, OtherServersAreReported) {
  TcpListener listener;
  const auto sender = sender_to(listener.port());
  TcpPeer peer = listener.accept();
  peer.send("HTTP/1.1 400 Bad Request\r\n\r\n");
  EXPECT_TRUE(fails_with(*sender, "it does not answer like an MQTT broker"));
}

TEST(MqttSender, EarlyEndIsReported) {
  TcpListener listener;
  const auto sender = sender_to(listener.port());
  listener.accept().close();
  EXPECT_TRUE(fails_with(*sender, "it closed the connection without an answer; it may need mqtts://"));
  TcpListener other;
  const auto encrypted = sender_to(other.port(), "mqtts");
  other.accept().close();
  EXPECT_TRUE(fails_with(*encrypted, kNoTls));
}

TEST(MqttSender, RejectionsHaveAReason) {
  const auto answer = [](char code, const std::string& user, const std::string& text) {
    TcpListener listener;
    const auto sender = sender_to(listener.port(), "mqtt", user);
    TcpPeer peer = listener.accept();
    peer.send(std::string("\x20\x02\x00", 3) + code);
    EXPECT_TRUE(fails_with(*sender, text));
  };
  answer(1, "", "it does not speak MQTT 3.1.1");
  answer(2, "", "it rejects the client id");
  answer(3, "", "it is not available now");
  answer(4, "a:secret@", "it rejects the user name or password");
  answer(5, "a:secret@", "it rejects the user name or password");
  answer(5, "", "it requires a user name and password");
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
  TcpListener mute;  // accepts the connection, then is silent
  auto sender = sender_to(mute.port());
  TcpPeer peer = mute.accept();
  peer.send(std::string("\x20\x02\x00\x00", 4));
  sender->begin(header);
  EXPECT_TRUE(ends_at_once(std::move(sender)));
}

TEST(MqttSender, CanBeCreatedRepeatedly) {
  const std::uint16_t port = free_port();
  for (int i = 0; i < 20; ++i) {
    const auto one = sender_to(port);
    const auto other = sender_to(port, "mqtts");
    EXPECT_EQ(one->status().sent, 0);
  }
}

TEST(MqttSender, OptionsAreChecked) {
  const auto refusal = [](const std::string& url) {
    return error_of([&] { make_sender(url, kAllSenderKinds); }, ErrorKind::usage);
  };
  const auto expect_error = [&](const std::string& url, const std::string& text) {
    EXPECT_NE(refusal(url).find(text), std::string::npos) << url << ": " << refusal(url);
  };
  expect_error("mqtt://localhost", "mqtt://localhost:1883/home/studio");
  expect_error("mqtt://localhost/home", "mqtt://localhost:1883/home/studio");
  expect_error("mqtt://localhost/home/studio/", "name a meeting");
  expect_error("mqtt://localhost/Home/studio", "name a meeting");
  expect_error("mqtt://localhost/home//studio", "name a meeting");
  expect_error("mqtt:///home/studio", "the computer to send to");
  expect_error("mqtt://localhost:0/home/studio", "port");
  expect_error("mqtt://localhost/a/b?nam=Ana", "name, look, seat, participant, key, ca, mirror");
  expect_error("mqtt://localhost/a/b?name=" + std::string(41, 'x'), "40 characters");
  expect_error("mqtt://localhost/a/b?name=%ff", "UTF-8");
  expect_error("mqtt://localhost/a/b?look=../x", "look");
  expect_error("mqtt://localhost/a/b?seat=100", "0 to 99");
  expect_error("mqtt://localhost/a/b?participant=a.b", "participant");
  expect_error("mqtt://localhost/a/b?ca=x.pem", "mqtts://");
  expect_error("mqtts://localhost/a/b?ca=/none.pem", "/none.pem");
  expect_error("mqtt://localhost/a/b?key=/none.json", "/none.json");
  expect_error("mqtt://localhost/a/b?name=a@b", "%40");
  EXPECT_EQ(refusal("mqtt://localhost/a/b?name=J%C3%B6rg&look=robot&seat=0&participant=p07&mirror=1"), "");
}

}  // namespace
}  // namespace telemime::meeting
