// SPDX-License-Identifier: Apache-2.0
// WebSockets as a page opens them, and as nobody should.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <vector>

#include "telemime/core/random.h"
#include "telemime/streaming/testing_web.h"
#include "telemime/streaming/testing_web_socket.h"

namespace telemime {
namespace {

WebHandlers echo() {
  WebHandlers handlers = small_page();
  handlers.text = [](std::uint64_t, std::string_view text) { return "you: " + std::string(text); };
  return handlers;
}

TEST(WebClient, IsGreetedHeardAndTold) {
  WebHandlers handlers = echo();
  handlers.opened = [](std::uint64_t) { return std::vector<std::string>{"one", "two", ""}; };
  WebServer server(any_port(), handlers);
  {
    SocketClient client(server.port());
    EXPECT_EQ(client.heard(), "one");
    EXPECT_EQ(client.heard(), "two");
    EXPECT_EQ(client.heard(), "");
    EXPECT_EQ(server.clients(), 1U);
    client.say("h\xC3\xA4llo");
    EXPECT_EQ(client.heard(), "you: h\xC3\xA4llo");
    client.send_frame(SocketClient::text, "in ", false);
    client.send_frame(SocketClient::ping, "?");
    client.send_frame(SocketClient::more, "parts");
    EXPECT_EQ(client.frame()->opcode, SocketClient::pong);
    EXPECT_EQ(client.heard(), "you: in parts");
    server.send_text(0, shared("to all"));
    EXPECT_EQ(client.heard(), "to all");
    server.send_binary(1, shared(std::string("\0\x01", 2)));
    const auto picture = client.message();
    EXPECT_EQ(picture->opcode, SocketClient::binary);
    EXPECT_EQ(picture->payload, std::string("\0\x01", 2));
    server.send_text(1, nullptr);  // nothing
    EXPECT_EQ(server.clients(), 1U);
  }
  EXPECT_TRUE(comes_true([&] { return server.clients() == 0; }));
}

TEST(WebClient, BreakingTheRulesClosesWithTheRightCode) {
  const WebServer server(any_port(), echo());
  struct Case {
    const char* what;
    std::uint8_t opcode;
    std::string payload;
    bool masked;
    int code;
  };
  for (const Case& wrong : std::vector<Case>{
           {"binary", SocketClient::binary, "x", true, 1003},
           {"no bytes of binary", SocketClient::binary, "", true, 1003},
           {"a byte too long", SocketClient::text, std::string(64 * 1024 + 1, 'x'), true, 1009},
           {"far too long", SocketClient::text, std::string(5'000'000, 'x'), true, 1009},
           {"not UTF-8", SocketClient::text, "a\xFF", true, 1007},
           {"over-long UTF-8", SocketClient::text, "\xC0\xAE", true, 1007},
           {"cut UTF-8", SocketClient::text, "\xE2\x82", true, 1007},
           {"unmasked", SocketClient::text, "x", false, 1002},
           {"reserved opcode", 3, "x", true, 1002},
           {"more of nothing", SocketClient::more, "x", true, 1002},
           {"a long ping", SocketClient::ping, std::string(126, 'x'), true, 1002},
           {"closed politely", SocketClient::close, "\x03\xE8", true, 1000},
       }) {
    SocketClient client(server.port());
    client.send_frame(wrong.opcode, wrong.payload, true, wrong.masked);
    EXPECT_EQ(client.close_code(), wrong.code) << wrong.what;
  }
  SocketClient client(server.port());
  client.say(std::string(64 * 1024, 'x'));  // just not too long
  EXPECT_EQ(client.heard().size(), 64U * 1024 + 5);
  client.send_frame(SocketClient::text, std::string(40'000, 'x'), false);
  client.send_frame(SocketClient::more, std::string(40'000, 'x'));  // too long in parts
  EXPECT_EQ(client.close_code(), 1009);
  EXPECT_TRUE(comes_true([&] { return server.clients() == 0; }));
}

TEST(WebClient, ThatIsOneTooManyIsToldSo) {
  WebServerOptions options = any_port();
  options.most_clients = 2;
  const WebServer server(options, echo());
  SocketClient first(server.port());
  auto second = std::make_unique<SocketClient>(server.port());
  ASSERT_TRUE(comes_true([&] { return server.clients() == 2; }));
  SocketClient third(server.port());
  const auto refusal = third.frame();
  ASSERT_TRUE(refusal);
  EXPECT_EQ(refusal->code(), 1013);
  EXPECT_EQ(refusal->payload.substr(2, 23), "Too many pages are open");
  second.reset();
  ASSERT_TRUE(comes_true([&] { return server.clients() == 1; }));
  SocketClient fourth(server.port());
  fourth.say("in?");
  EXPECT_EQ(fourth.heard(), "you: in?");
  first.say("and I?");
  EXPECT_EQ(first.heard(), "you: and I?");
}

TEST(WebClient, HandlersThatThrowAreReportedAndSurvived) {
  WebHandlers handlers;
  handlers.opened = [](std::uint64_t) -> std::vector<std::string> {
    throw std::runtime_error("no greeting");
  };
  handlers.text = [](std::uint64_t, std::string_view text) -> std::optional<std::string> {
    if (text == "number") {
      throw 7;
    }
    throw std::runtime_error("bad \xFF words");
  };
  const WebServer server(any_port(), handlers);
  for (int i = 0; i < 2; ++i) {
    SocketClient client(server.port());
    const auto greeting = nlohmann::json::parse(client.heard());
    EXPECT_EQ(greeting, (nlohmann::json{{"type", "message"}, {"level", "error"}, {"words", "no greeting"}}));
    client.say("x");
    EXPECT_EQ(nlohmann::json::parse(client.heard()).at("words"), "bad \xEF\xBF\xBD words");
    client.say("number");
    EXPECT_EQ(nlohmann::json::parse(client.heard()).at("level"), "error");
  }
  EXPECT_TRUE(comes_true([&] { return server.clients() == 0; }));
}

TEST(WebClient, TenHearTheSameInTheSameOrder) {
  WebServer server(any_port(), echo());
  std::vector<std::unique_ptr<SocketClient>> ten;
  for (int i = 0; i < 10; ++i) {
    ten.push_back(std::make_unique<SocketClient>(server.port()));
  }
  ASSERT_TRUE(comes_true([&] { return server.clients() == 10; }));
  for (int i = 0; i < 500; ++i) {
    server.send_text(0, shared(std::to_string(i)));
  }
  for (const auto& client : ten) {
    for (int i = 0; i < 500; ++i) {
      ASSERT_EQ(client->heard(), std::to_string(i));
    }
  }
}

TEST(WebClient, ATopicCanBeTurnedOffForOne) {
  WebServer* page = nullptr;
  WebHandlers handlers = echo();
  handlers.text = [&](std::uint64_t id, std::string_view text) {
    page->set_topic(id, 1, text == "on");
    return std::optional<std::string>(text);
  };
  WebServer server(any_port(), handlers);
  page = &server;
  SocketClient hidden(server.port());
  SocketClient shown(server.port());
  hidden.say("off");
  EXPECT_EQ(hidden.heard(), "off");
  ASSERT_TRUE(comes_true([&] { return server.clients() == 2; }));
  server.send_text(1, shared("picture"));
  EXPECT_EQ(shown.heard(), "picture");
  server.send_text(2, shared("pose"));
  EXPECT_EQ(hidden.heard(), "pose");
  hidden.say("on");
  EXPECT_EQ(hidden.heard(), "on");
  server.send_text(1, shared("picture"));
  EXPECT_EQ(hidden.heard(), "picture");
  server.set_topic(999, 1, false);  // nobody
}

/// What a real program does with a message: parse it, complain, answer.
std::optional<std::string> parse_and_answer(std::uint64_t, std::string_view text) {
  const nlohmann::json message = nlohmann::json::parse(text);
  return "type " + message.at("type").get<std::string>();
}

std::string random_message(Random& random) {
  static const std::vector<std::string> valid = {
      R"({"type":"guide","step":"empty"})", R"({"type":"output","add":"vmc://localhost:39539"})",
      R"({"type":"record","on":true})", R"({"type":"drawn","frame":12,"stamp":1234.5})"};
  std::string message;
  switch (random.below(3)) {
    case 0:
      message.resize(random.below(200));
      for (char& c : message) {
        c = static_cast<char>(random.below(256));
      }
      return message;
    case 1:
      for (std::uint32_t n = random.below(40); n > 0; --n) {
        static const std::vector<std::string> tokens = {
            "{", "}", "[", "]", ":", ",", "\"type\"", "1", "\"", "null", "-1e999", "\\u0000", "true", " "};
        message += tokens[random.below(static_cast<std::uint32_t>(tokens.size()))];
      }
      return message;
    default:
      message = valid[random.below(static_cast<std::uint32_t>(valid.size()))];
      for (std::uint32_t n = random.below(4); n > 0; --n) {
        const std::size_t at = random.below(static_cast<std::uint32_t>(message.size()));
        random.below(2) == 0 ? message.erase(at, 1)
                             : message.insert(at, 1, static_cast<char>(random.below(256)));
      }
      return message;
  }
}

TEST(WebClient, TenThousandRandomMessagesAreSurvived) {
  WebHandlers handlers = small_page();
  handlers.text = parse_and_answer;
  const WebServer server(any_port(), handlers);
  Random random(5, 1);
  auto client = std::make_unique<SocketClient>(server.port());
  int answers = 0;
  for (int i = 0; i < 10'000; ++i) {
    // One in twenty breaks the rules of WebSockets, too.
    const bool strange = random.below(20) == 0;
    const auto opcode =
        strange ? static_cast<std::uint8_t>(random.below(16)) : std::uint8_t{SocketClient::text};
    if (!client->send_frame(opcode, random_message(random), random.below(50) != 0, random.below(50) != 0) ||
        !client->send_frame(SocketClient::ping, "on?")) {
      client = std::make_unique<SocketClient>(server.port());
      continue;
    }
    std::optional<SocketClient::Frame> frame = client->frame();
    while (frame && frame->opcode != SocketClient::close && frame->payload != "on?") {
      answers += frame->opcode == SocketClient::text;
      frame = client->frame();
    }
    if (!frame || frame->opcode == SocketClient::close) {
      client = std::make_unique<SocketClient>(server.port());
    }
  }
  EXPECT_GT(answers, 3000);
  EXPECT_EQ(ask(server.port(), "/").status, 200);
  SocketClient last(server.port());
  last.say(R"({"type":"ping"})");
  EXPECT_EQ(last.heard(), "type ping");
}

}  // namespace
}  // namespace telemime
