// SPDX-License-Identifier: Apache-2.0
#include "telemime/streaming/web_server.h"

#include <gtest/gtest.h>

#include <future>
#include <vector>

#include "telemime/core/testing_errors.h"
#include "telemime/streaming/testing_web.h"
#include "telemime/streaming/testing_web_socket.h"

namespace telemime {
namespace {

using std::chrono::milliseconds;

std::string local_header(std::uint16_t port) {
  return "http://localhost:" + std::to_string(port);
}

bool has_ipv6() {
  const int fd = ::socket(AF_INET6, SOCK_STREAM, 0);
  sockaddr_in6 any{};
  any.sin6_family = AF_INET6;
  any.sin6_addr = in6addr_loopback;
  const bool works = fd >= 0 && ::bind(fd, reinterpret_cast<sockaddr*>(&any), sizeof any) == 0;
  ::close(fd);
  return works;
}

TEST(WebServer, AnswersWithTheContentAndItsGuards) {
  WebHandlers handlers;
  handlers.get = [](const std::string& path) -> std::optional<WebContent> {
    const auto bytes = shared("bytes of " + path);
    WebContent content{bytes, "text/x-test", path == "/save" ? "mo\"ti\non.bvh" : "", path == "/hashed"};
    content.connects = path == "/open" ? "https:" : "";
    return content;
  };
  const WebServer server(any_port(), handlers);
  const WebReply page = ask(server.port(), "/a%20b?c");
  EXPECT_EQ(page.status, 200);
  EXPECT_EQ(page.body, "bytes of /a b");
  EXPECT_EQ(page.header("Content-Type"), "text/x-test");
  EXPECT_EQ(page.header("Cache-Control"), "no-store");
  EXPECT_EQ(page.header("X-Content-Type-Options"), "nosniff");
  EXPECT_EQ(page.header("Referrer-Policy"), "no-referrer");
  EXPECT_EQ(page.header("Cross-Origin-Resource-Policy"), "same-origin");
  EXPECT_EQ(page.header("Content-Disposition"), "");
  EXPECT_EQ(page.header("Access-Control-Allow-Origin"), "");
  const std::string policy = page.header("Content-Security-Policy");
  EXPECT_NE(policy.find("default-src 'none'; script-src 'self';"), std::string::npos) << policy;
  EXPECT_NE(policy.find(" ws://localhost:" + std::to_string(server.port()) + ";"), std::string::npos)
      << policy;
  EXPECT_NE(policy.find("frame-ancestors 'none'"), std::string::npos) << policy;
  EXPECT_EQ(policy.find("https:"), std::string::npos) << policy;
  const std::string open = ask(server.port(), "/open").header("Content-Security-Policy");
  EXPECT_NE(open.find(std::to_string(server.port()) + " https:;"), std::string::npos) << open;

  EXPECT_EQ(ask(server.port(), "/hashed").header("Cache-Control"), "public, max-age=31536000, immutable");
  EXPECT_EQ(ask(server.port(), "/save").header("Content-Disposition"),
            "attachment; filename=\"mo_ti_on.bvh\"");
}

TEST(WebServer, AnswersSeveralRequestsOnOneConnection) {
  const WebServer server(any_port(), small_page());
  RawClient client(server.port());
  const std::string request = request_text(server.port(), "/");
  client.send(request + request_text(server.port(), "/none-closes") + request);
  EXPECT_EQ(client.reply().body, "<p>here</p>");
  EXPECT_EQ(client.reply().status, 404);
  EXPECT_EQ(client.rest(), "");

  RawClient kept(server.port());
  for (int i = 0; i < 5; ++i) {
    kept.send(request);
    EXPECT_EQ(kept.reply().body, "<p>here</p>");
  }
  kept.send(request_text(server.port(), "/", "Connection: close\r\n"));
  EXPECT_EQ(kept.reply().status, 200);
  EXPECT_EQ(kept.rest(), "");
}

TEST(WebServer, HeadHasNoBody) {
  const WebServer server(any_port(), small_page());
  RawClient client(server.port());
  client.send(request_text(server.port(), "/", "", "HEAD") + request_text(server.port(), "/"));
  const WebReply head = client.reply(/*head=*/true);
  EXPECT_EQ(head.header("Content-Length"), "11");
  EXPECT_EQ(client.reply().body, "<p>here</p>");  // what follows is the next answer
  EXPECT_EQ(ask(server.port(), "/none", "", "HEAD").status, 404);
}

TEST(WebServer, BigContentArrivesWhole) {
  std::string big(20'000'000, ' ');
  for (std::size_t i = 0; i < big.size(); ++i) {
    big[i] = static_cast<char>(i * 2654435761U >> 24);
  }
  WebHandlers handlers;
  handlers.get = [bytes = shared(big)](const std::string&) {
    return std::optional(WebContent{bytes, "application/octet-stream", "", false});
  };
  const WebServer server(any_port(), handlers);
  EXPECT_TRUE(ask(server.port(), "/").body == big);
}

TEST(WebServer, WithoutHandlersThereIsNothing) {
  const WebServer server(any_port(), {});
  EXPECT_EQ(ask(server.port(), "/").status, 404);
  SocketClient client(server.port());
  client.say("{}");
  client.send_frame(SocketClient::ping, "still here");
  EXPECT_EQ(client.frame()->payload, "still here");
}

TEST(WebServer, AHandlerThatThrowsIsAnswered500) {
  WebHandlers handlers;
  handlers.get = [](const std::string& path) -> std::optional<WebContent> {
    if (path == "/number") {
      throw 7;
    }
    throw std::runtime_error("the disk is gone");
  };
  const WebServer server(any_port(), handlers);
  const WebReply reply = ask(server.port(), "/");
  EXPECT_EQ(reply.status, 500);
  EXPECT_NE(reply.body.find("the disk is gone"), std::string::npos);
  EXPECT_EQ(ask(server.port(), "/number").status, 500);
}

TEST(WebServer, ListensAtBothLoopbacks) {
  if (!has_ipv6()) {
    GTEST_SKIP() << "this machine has no ::1";
  }
  const WebServer server(any_port(), small_page());
  RawClient client(server.port(), "::1");
  client.send("GET / HTTP/1.1\r\nHost: [::1]:" + std::to_string(server.port()) + "\r\n\r\n");
  EXPECT_EQ(client.reply().status, 200);
}

void expect_taken(const WebServerOptions& options) {
  const std::string message = error_of(ErrorKind::output, [&] { WebServer(options, small_page()); });
  EXPECT_NE(message.find("port " + std::to_string(options.port) + " is taken"), std::string::npos) << message;
  EXPECT_NE(message.find("--port "), std::string::npos) << message;
}

TEST(WebServer, APortThatIsTakenIsAnError) {
  auto first = std::make_unique<WebServer>(any_port(), small_page());
  WebServerOptions options;
  options.port = first->port();
  expect_taken(options);
  EXPECT_EQ(ask(options.port, "/").status, 200);
  first.reset();
  const WebServer again(options, small_page());  // at once, though a connection has just ended
  EXPECT_EQ(ask(options.port, "/").status, 200);
}

TEST(WebServer, APortThatIsTakenAtTheOtherLoopbackIsAnError) {
  if (!has_ipv6()) {
    GTEST_SKIP() << "this machine has no ::1";
  }
  WebServerOptions other = any_port();
  other.address = "::1";
  const WebServer first(other, small_page());
  WebServerOptions options;
  options.port = first.port();
  expect_taken(options);
}

TEST(WebServer, AnAddressThatIsNoneIsAnError) {
  for (const char* address : {"", "nowhere", "127.0.0.1:80", "256.0.0.1", "203.0.113.7"}) {
    WebServerOptions options = any_port();
    options.address = address;
    EXPECT_NE(error_of(ErrorKind::usage, [&] { WebServer(options, {}); }), "") << address;
  }
}

TEST(WebServer, AnotherAddressMayBeAskedForByItsNumber) {
  WebServerOptions options = any_port();
  options.address = "0.0.0.0";
  const WebServer server(options, small_page());
  RawClient client(server.port(), "127.0.0.9");
  client.send("GET / HTTP/1.1\r\nHost: 127.0.0.9:" + std::to_string(server.port()) + "\r\n\r\n");
  EXPECT_EQ(client.reply().status, 200);
}

TEST(WebServer, TooManyConnectionsAreTurnedAwayInWords) {
  WebServerOptions options = any_port();
  options.most_clients = 1;
  const WebServer server(options, small_page());
  std::vector<std::unique_ptr<RawClient>> silent;
  for (int i = 0; i < 97; ++i) {
    silent.push_back(std::make_unique<RawClient>(server.port()));
  }
  RawClient one_more(server.port());
  EXPECT_EQ(one_more.reply().status, 503);
  silent.clear();
  EXPECT_TRUE(comes_true([&] { return ask(server.port(), "/").status == 200; }));
}

TEST(WebServer, KeepsNoConnectionsWhenManyAreOpen) {
  const WebServer server(any_port(), small_page());
  EXPECT_EQ(ask(server.port(), "/").header("Connection"), "");
  std::vector<std::unique_ptr<RawClient>> silent;
  for (int i = 0; i < 105; ++i) {
    silent.push_back(std::make_unique<RawClient>(server.port()));
  }
  const auto answer = ask(server.port(), "/");
  EXPECT_EQ(answer.status, 200);
  EXPECT_EQ(answer.header("Connection"), "close");
}

TEST(WebServer, EndsSoonWithConnectionsInEveryState) {
  WebHandlers handlers = small_page();
  const auto huge = shared(std::string(30'000'000, 'x'));
  handlers.get = [&](const std::string&) { return std::optional(WebContent{huge, "text/plain", "", false}); };
  auto server = std::make_unique<WebServer>(any_port(), handlers);
  const RawClient silent(server->port());
  const RawClient half(server->port());
  half.send("GET / HT");
  const RawClient not_reading(server->port(), "127.0.0.1", 4096);
  not_reading.send(request_text(server->port(), "/"));
  SocketClient open(server->port());
  const SocketClient stalled(server->port(), "", 4096);
  ASSERT_TRUE(comes_true([&] { return server->clients() == 2; }));
  server->send_binary(1, huge);
  EXPECT_EQ(open.heard().size(), huge->size());
  std::size_t left = 2;
  auto ended = std::async(std::launch::async, [&] {
    server->stop();
    left = server->clients();
    server.reset();
  });
  EXPECT_EQ(ended.wait_for(std::chrono::seconds(20)), std::future_status::ready);
  EXPECT_EQ(left, 0U);
  EXPECT_FALSE(open.frame());
}

TEST(WebServer, AnswersAnOriginOfItsOwn) {
  const WebServer server(any_port(), small_page());
  EXPECT_EQ(ask(server.port(), "/", "Origin: " + local_header(server.port()) + "\r\n").status, 200);
  const SocketClient client(server.port(), "Origin: " + local_header(server.port()) + "\r\n");
  EXPECT_EQ(client.handshake().header("Sec-WebSocket-Extensions"), "");
}

}  // namespace
}  // namespace telemime
