// SPDX-License-Identifier: Apache-2.0
// What is posted to a server: bodies, their bounds, answers that take their time.
#include <gtest/gtest.h>

#include <future>

#include "telemime/streaming/testing_web.h"

namespace telemime {
namespace {

/// Answers with what came, and 201.
WebHandlers echo() {
  WebHandlers handlers = small_page();
  handlers.post = [](const WebPost& post, const std::function<void(WebContent)>& answer) {
    WebContent content;
    content.bytes = shared(post.path + "|" + post.type + "|" + post.address + "|" + post.body);
    content.type = "text/plain";
    content.status = 201;
    answer(content);
  };
  handlers.policy = [](std::string_view host) { return "default-src 'none' " + std::string(host); };
  return handlers;
}

std::string post_text(std::uint16_t port, const std::string& body, const std::string& headers = "") {
  return request_text(port, "/a%20b?x", headers + "Content-Length: " + std::to_string(body.size()) + "\r\n",
                      "POST") +
         body;
}

TEST(WebPost, ReachesItsHandlerAndIsAnswered) {
  const WebServer server(any_port(), echo());
  RawClient client(server.port());
  for (const char* const body : {"hello", "", "a\nb"}) {  // one connection
    client.send(post_text(server.port(), body, "Content-Type: text/x\r\n"));
    const WebReply reply = client.reply();
    EXPECT_EQ(reply.status, 201);
    EXPECT_EQ(reply.body, std::string("/a b|text/x|127.0.0.1|") + body);
    EXPECT_EQ(reply.header("Cache-Control"), "no-store");
    EXPECT_EQ(reply.header("Content-Security-Policy"),
              "default-src 'none' localhost:" + std::to_string(server.port()));
  }
  client.send(request_text(server.port(), "/"));
  EXPECT_EQ(client.reply().body, "<p>here</p>") << "and other requests after it";
}

TEST(WebPost, MayComeInPieces) {
  const WebServer server(any_port(), echo());
  RawClient client(server.port());
  for (const char c : post_text(server.port(), "slowly")) {
    client.send({&c, 1});
  }
  EXPECT_EQ(client.reply().body, "/a b||127.0.0.1|slowly");
  client.send(request_text(server.port(), "/x", "Transfer-Encoding: chunked\r\n", "POST") +
              "3\r\nabc\r\n2\r\nde\r\n0\r\n\r\n");
  EXPECT_EQ(client.reply().body, "/x||127.0.0.1|abcde");
}

TEST(WebPost, WhatIsTooLongIsRefused) {
  WebServerOptions options = any_port();
  options.most_posted = 10;
  const WebServer server(options, echo());
  const auto status = [&](const std::string& text) { return reply_to(server.port(), text).status; };
  EXPECT_EQ(status(post_text(server.port(), "0123456789")), 201);
  EXPECT_EQ(status(post_text(server.port(), "0123456789a")), 413);
  EXPECT_EQ(status(request_text(server.port(), "/", "Content-Length: 99999999999\r\n", "POST")), 413);
  EXPECT_EQ(status(request_text(server.port(), "/", "Transfer-Encoding: chunked\r\n", "POST") +
                   "6\r\nabcdef\r\n6\r\nabcdef\r\n0\r\n\r\n"),
            413);
}

TEST(WebPost, OfOtherWebSitesIsRefused) {
  int asked = 0;
  WebHandlers handlers = echo();
  handlers.post = [&asked](const WebPost&, const std::function<void(WebContent)>& answer) {
    ++asked;
    answer({});
  };
  WebServer server(any_port(), handlers);
  for (const char* const header : {"Origin: http://evil.example\r\n", "Origin: null\r\n", "Origin: \r\n",
                                   "Sec-Fetch-Site: cross-site\r\n", "Host: evil.example\r\n"}) {
    const int status = reply_to(server.port(), post_text(server.port(), "x", header)).status;
    EXPECT_TRUE(status == 403 || status == 400) << header << status;
  }
  server.stop();
  EXPECT_EQ(asked, 0);
}

TEST(WebPost, WithoutAHandlerThereIsNone) {
  const WebServer server(any_port(), small_page());
  EXPECT_EQ(ask(server.port(), "/", "Content-Length: 0\r\n", "POST").status, 405);
}

TEST(WebPost, ItsAnswerMayComeLaterFromElsewhere) {
  std::promise<std::function<void(WebContent)>> asked;
  WebHandlers handlers = small_page();
  handlers.post = [&asked](const WebPost&, std::function<void(WebContent)> answer) {
    asked.set_value(answer);
  };
  std::function<void(WebContent)> late;
  {
    const WebServer server(any_port(), handlers);
    RawClient client(server.port());
    client.send(post_text(server.port(), "x") + request_text(server.port(), "/", "", "HEAD") +
                request_text(server.port(), "/"));
    late = asked.get_future().get();
    EXPECT_EQ(ask(server.port(), "/").status, 200) << "nobody waits for it";
    WebContent content;
    content.bytes = shared("at last");
    content.type = "text/plain";
    late(content);
    EXPECT_EQ(client.reply().body, "at last");
    EXPECT_EQ(client.reply(/*head=*/true).header("Content-Length"), "11") << "what was requested behind it";
    EXPECT_EQ(client.reply().body, "<p>here</p>");
    late(content);  // a second time: nobody waits
  }
  late({});  // the server is gone
}

TEST(WebPost, WhoWaitsTooLongIsTold) {
  WebServerOptions options = any_port();
  options.stalled_after = std::chrono::milliseconds(50);
  WebHandlers handlers = small_page();
  handlers.post = [](const WebPost&, const std::function<void(WebContent)>&) {};
  const WebServer server(options, handlers);
  EXPECT_EQ(reply_to(server.port(), post_text(server.port(), "x")).status, 503);
}

TEST(WebPost, AHandlerThatThrowsIsAnErrorOfTheServer) {
  WebHandlers handlers = small_page();
  handlers.post = [](const WebPost&, const std::function<void(WebContent)>&) {
    throw std::runtime_error("secret");
  };
  const WebServer server(any_port(), handlers);
  const WebReply reply = reply_to(server.port(), post_text(server.port(), "x"));
  EXPECT_EQ(reply.status, 500);
  EXPECT_EQ(reply.body.find("secret"), std::string::npos);
}

}  // namespace
}  // namespace telemime
