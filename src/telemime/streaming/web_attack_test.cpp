// SPDX-License-Identifier: Apache-2.0
// What a hostile page, program or accident can do to the server over HTTP.
#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "telemime/core/random.h"
#include "telemime/streaming/testing_web.h"
#include "telemime/streaming/testing_web_socket.h"

namespace telemime {
namespace {

/// A server that answers every path, and remembers them.
class Attack : public ::testing::Test {
 protected:
  static WebHandlers anything(std::atomic<int>& asked) {
    WebHandlers handlers;
    handlers.get = [&asked](const std::string&) {
      ++asked;
      return std::optional<WebContent>(WebContent{shared("secret"), "text/plain", "", false});
    };
    handlers.text = [](std::uint64_t, std::string_view) { return std::optional<std::string>("secret"); };
    return handlers;
  }
  int with_headers(const std::string& headers, const std::string& target = "/") const {
    return reply_to(server_.port(), "GET " + target + " HTTP/1.1\r\n" + headers + "\r\n").status;
  }
  std::string here() const { return "localhost:" + std::to_string(server_.port()); }
  std::string host() const { return "Host: " + here() + "\r\n"; }
  void TearDown() override {
    asked_ = 0;
    EXPECT_EQ(ask(server_.port(), "/").status, 200) << "the server no longer answers";
    EXPECT_EQ(asked_, 1);
  }

  std::atomic<int> asked_ = 0;
  const WebServer server_{any_port(), anything(asked_)};
};

TEST_F(Attack, PathsThatLeadOutNeverReachTheHandler) {
  for (const char* target : {"/../etc/passwd", "/%2e%2e/etc/passwd", "/..%2f..%2fetc/passwd", "/a/%2e%2e%5c",
                             "/%c0%ae%c0%ae/", "/%00", "/a%00.js", "\\..\\", "/%", "http://localhost/", "*",
                             "/%0d%0aX:%20y", "localhost:80", "/%ff"}) {
    EXPECT_EQ(ask(server_.port(), target).status, 400) << target;
  }
  EXPECT_EQ(asked_, 0);
  EXPECT_EQ(ask(server_.port(), "/%252e%252e/").status, 200);  // a strange name, but only a name
}

TEST_F(Attack, OtherHostsAreRefused) {
  const std::string port = std::to_string(server_.port());
  for (const std::string& name :
       {"evil.com:" + port, std::string("evil.com"), std::string("localhost"), "localhost.evil.com:" + port,
        "0.0.0.0:" + port, std::string("localhost:1")}) {
    EXPECT_EQ(with_headers("Host: " + name + "\r\n"), 403) << name;
    EXPECT_EQ(with_headers("Host: " + name + "\r\n" + upgrade_headers, "/ws"), 403) << name;
  }
  EXPECT_EQ(with_headers(""), 400);
  EXPECT_EQ(with_headers(host() + "Host: evil.com\r\n"), 400);
  EXPECT_EQ(with_headers("Host: evil.com\r\n" + host()), 400);
  EXPECT_EQ(reply_to(server_.port(), "GET / HTTP/1.0\r\n\r\n").status, 400);
  EXPECT_EQ(with_headers("Host: evil.com\r\nX-Forwarded-Host: " + here() + "\r\n"), 403);
  EXPECT_EQ(asked_, 0);
}

TEST_F(Attack, OtherOriginsAreRefused) {
  const std::string own = "Origin: http://" + here() + "\r\n";
  for (const char* origin : {"http://evil.com", "null", "http://localhost", "http://localhost:3000",
                             "file://", "https://localhost:1", ""}) {
    const std::string line = std::string("Origin: ") + origin + "\r\n";
    EXPECT_EQ(with_headers(host() + line), 403) << origin;
    EXPECT_EQ(with_headers(host() + line + upgrade_headers, "/ws"), 403) << origin;
    EXPECT_EQ(with_headers(host() + own + line), 403) << origin;
  }
  EXPECT_EQ(asked_, 0);
  EXPECT_EQ(server_.clients(), 0U);
}

TEST_F(Attack, PagesThatEmbedWhatIsHereAreRefused) {
  EXPECT_EQ(with_headers(host() + "Sec-Fetch-Site: cross-site\r\nSec-Fetch-Mode: no-cors\r\n"), 403);
  EXPECT_EQ(with_headers(host() + "Sec-Fetch-Site: same-site\r\nSec-Fetch-Mode: cors\r\n"), 403);
  EXPECT_EQ(with_headers(host() + "Sec-Fetch-Site: cross-site\r\nSec-Fetch-Mode: navigate\r\n"), 200);
  EXPECT_EQ(with_headers(host() + "Sec-Fetch-Site: same-origin\r\nSec-Fetch-Mode: no-cors\r\n"), 200);
}

TEST_F(Attack, OtherMethodsAreRefused) {
  for (const char* method :
       {"POST", "PUT", "DELETE", "OPTIONS", "PATCH", "TRACE", "CONNECT", "PROPFIND", "SECRET"}) {
    const WebReply reply = ask(server_.port(), "/", "Content-Length: 3\r\n", method);
    EXPECT_EQ(reply.status, 405) << method;
    EXPECT_EQ(reply.header("Allow"), "GET, HEAD");
  }
  EXPECT_EQ(asked_, 0);
}

TEST_F(Attack, WhatIsTooLongIsRefused) {
  EXPECT_EQ(with_headers(host() + "X: " + std::string(100'000, 'x') + "\r\n"), 431);
  std::string many = host();
  for (int i = 0; i < 20'000; ++i) {
    many += "X" + std::to_string(i) + ": y\r\n";
  }
  EXPECT_EQ(with_headers(many), 431);
  EXPECT_EQ(ask(server_.port(), "/" + std::string(1'000'000, 'a')).status, 431);
  EXPECT_EQ(ask(server_.port(), "/" + std::string(5'000, 'a')).status, 414);
  EXPECT_EQ(ask(server_.port(), "/", "Content-Length: 10\r\n").status, 413);
  EXPECT_EQ(ask(server_.port(), "/", "Content-Length: 99999999999\r\n").status, 413);
  EXPECT_EQ(ask(server_.port(), "/", "Transfer-Encoding: chunked\r\n").status, 413);
  EXPECT_EQ(ask(server_.port(), "/", "Cookie: " + std::string(20'000, 'c') + "\r\n").status, 200);
}

TEST_F(Attack, WhatIsNoRequestIsRefused) {
  for (const std::string& bytes :
       {std::string("hello\r\n\r\n"), std::string("\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03", 11),
        std::string("GET / HTTP/9.9\r\n\r\n"), std::string("GET /\r\n\r\n"),
        std::string("GET / HTTP/1.1\r\n:\r\n\r\n"), std::string("GET / HTTP/1.1\r\nHost : x\r\n\r\n"),
        std::string(64, '\0'), std::string("GET /\0 HTTP/1.1\r\n\r\n", 19),
        std::string("PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n"),
        "GET / HTTP/1.1\r\n" + host() + "Content-Length: 1\r\nContent-Length: 2\r\n\r\n",
        "GET / HTTP/1.1\r\n" + host() + "Content-Length: -1\r\n\r\n"}) {
    RawClient client(server_.port());
    client.send(bytes);
    client.end_of_sending();
    EXPECT_EQ(client.reply().status, 400) << bytes;
  }
  EXPECT_EQ(asked_, 0);
}

TEST_F(Attack, RandomBytesAreSurvived) {
  Random random(11, 1);
  const std::string valid = request_text(server_.port(), "/ws", upgrade_headers);
  for (int i = 0; i < 600; ++i) {
    RawClient client(server_.port());
    std::string bytes = i % 2 == 0 ? std::string(random.below(2000), ' ') : valid;
    for (char& c : bytes) {
      if (i % 2 == 0 || random.below(60) == 0) {
        c = static_cast<char>(random.below(256));
      }
    }
    client.send(bytes);
    client.end_of_sending();
    client.rest();  // returns: the server closes
  }
  EXPECT_TRUE(comes_true([&] { return server_.clients() == 0; }));
}

TEST_F(Attack, AWebSocketIsOnlyThere) {
  EXPECT_EQ(ask(server_.port(), "/", upgrade_headers).status, 200);  // taken as an ordinary request
  const WebReply plain = ask(server_.port(), "/ws");
  EXPECT_EQ(plain.status, 426);
  EXPECT_EQ(plain.header("Upgrade"), "websocket");
  // What comes with the request cannot have been a WebSocket's.
  EXPECT_EQ(reply_to(server_.port(), request_text(server_.port(), "/ws", upgrade_headers) + "more").status,
            400);
}

TEST(SlowAttack, ClientsThatDawdleAreClosed) {
  WebServerOptions options = any_port();
  options.request_within = std::chrono::milliseconds(1000);
  const WebServer server(options, small_page());
  RawClient silent(server.port());
  RawClient slow(server.port());
  slow.send("GET / HTTP/1.1\r\nX: ");
  int sent = 0;
  while (slow.send("x") && sent < 6000) {  // a minute at most: it never is idle for long
    ++sent;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    if (sent % 10 == 0) {
      EXPECT_EQ(ask(server.port(), "/").status, 200);
    }
  }
  EXPECT_LT(sent, 6000);
  EXPECT_EQ(silent.rest(), "");
  RawClient idle(server.port());
  idle.send(request_text(server.port(), "/"));
  EXPECT_EQ(idle.reply().status, 200);
  EXPECT_EQ(idle.rest(), "");
}

TEST(SlowAttack, WhoDoesNotReadAnAnswerIsClosed) {
  WebServerOptions options = any_port();
  options.stalled_after = std::chrono::milliseconds(200);
  std::weak_ptr<const std::string> content;
  WebHandlers handlers;
  handlers.get = [&](const std::string&) {
    const auto huge = shared(std::string(50'000'000, 'x'));
    content = huge;
    return std::optional(WebContent{huge, "text/plain", "", false});
  };
  const WebServer server(options, handlers);
  RawClient client(server.port(), "127.0.0.1", 4096);
  client.send(request_text(server.port(), "/"));
  ASSERT_TRUE(client.fill(1));
  EXPECT_TRUE(comes_true([&] { return content.expired(); }));
}

}  // namespace
}  // namespace telemime
