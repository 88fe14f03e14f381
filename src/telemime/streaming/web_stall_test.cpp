// SPDX-License-Identifier: Apache-2.0
// Clients that do not read, or are dead.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "telemime/streaming/testing_web.h"
#include "telemime/streaming/testing_web_socket.h"

namespace telemime {
namespace {

TEST(WebStall, CostsTheOthersNothingAndLittleMemory) {
  WebServer server(any_port(), {});
  const SocketClient stalled(server.port(), "", 4096);
  SocketClient reading(server.port());
  ASSERT_TRUE(comes_true([&] { return server.clients() == 2; }));
  std::vector<std::weak_ptr<const std::string>> sent;
  std::size_t most_alive = 0;
  for (int i = 0; i < 200; ++i) {
    for (const int topic : {1, 2}) {
      auto picture = shared(std::string(1'000'000, static_cast<char>(topic)));
      sent.push_back(picture);
      server.send_binary(topic, std::move(picture));
    }
    server.send_text(0, shared(std::to_string(i)));
    auto next = reading.message();
    while (next && next->opcode == SocketClient::binary) {
      next = reading.message();
    }
    ASSERT_TRUE(next);
    ASSERT_EQ(next->payload, std::to_string(i));
    std::erase_if(sent, [](const auto& picture) { return picture.expired(); });
    most_alive = std::max(most_alive, sent.size());
  }
  // Of two topics: on the way to all, being given out, and, for each of the two clients, waiting or being
  // written.
  EXPECT_LE(most_alive, 2U + 2U + 2U * 3U);
  EXPECT_EQ(server.clients(), 2U);  // it has 30 s
}

TEST(WebStall, IsClosedAfterAWhileThoughItTalks) {
  WebServerOptions options = any_port();
  options.stalled_after = std::chrono::milliseconds(300);
  WebServer server(options, {});
  const SocketClient stalled(server.port(), "", 4096);
  ASSERT_TRUE(comes_true([&] { return server.clients() == 1; }));
  const auto picture = shared(std::string(30'000'000, 'x'));
  server.send_binary(1, picture);
  EXPECT_TRUE(comes_true([&] { return !stalled.say("I am alive") || server.clients() == 0; }));
  EXPECT_TRUE(comes_true([&] { return server.clients() == 0 && picture.use_count() == 1; }));
}

TEST(WebStall, TooManyImportantMessagesCloseIt) {
  WebServer server(any_port(), {});
  SocketClient stalled(server.port(), "", 4096);
  ASSERT_TRUE(comes_true([&] { return server.clients() == 1; }));
  const auto text = shared(std::string(100'000, 'x'));
  for (int i = 0; i < 1100 && server.clients() == 1; ++i) {
    server.send_text(0, text);
  }
  EXPECT_TRUE(comes_true([&] { return server.clients() == 0 && text.use_count() == 1; }));
}

TEST(WebStall, AFloodOfQuestionsWithoutReadingTheAnswersClosesIt) {
  WebHandlers handlers;
  handlers.text = [](std::uint64_t, std::string_view) { return std::optional(std::string(50'000, 'x')); };
  const WebServer server(any_port(), handlers);
  const SocketClient flood(server.port(), "", 4096);
  int asked = 0;
  while (asked < 5000 && flood.say("?")) {
    ++asked;
  }
  EXPECT_TRUE(comes_true([&] { return server.clients() == 0; }));
}

TEST(WebStall, ASlowReaderIsNotClosed) {
  WebServerOptions options = any_port();
  options.stalled_after = std::chrono::milliseconds(1000);
  WebServer server(options, {});
  SocketClient slow(server.port(), "", 4096);
  ASSERT_TRUE(comes_true([&] { return server.clients() == 1; }));
  const auto picture = shared(std::string(3'000'000, 'x'));
  server.send_binary(1, picture);
  std::size_t read = 0;
  while (read < picture->size()) {  // takes longer than stalled_after, never without progress
    const auto part = slow.frame();
    ASSERT_TRUE(part);
    read += part->opcode == SocketClient::ping ? 0 : part->payload.size();
    slow.say("I am alive");
    std::this_thread::sleep_for(std::chrono::milliseconds(25));
  }
  EXPECT_EQ(server.clients(), 1U);
}

TEST(WebStall, ASilentClientIsAskedAndClosedWhenItIsDead) {
  WebServerOptions options = any_port();
  options.stalled_after = std::chrono::milliseconds(1500);
  const WebServer server(options, {});
  SocketClient alive(server.port());
  SocketClient dead(server.port());
  ASSERT_TRUE(comes_true([&] { return server.clients() == 2; }));
  int pings = 0;
  while (server.clients() == 2) {
    const auto frame = alive.frame();
    ASSERT_TRUE(frame);
    ASSERT_EQ(frame->opcode, SocketClient::ping);
    alive.send_frame(SocketClient::pong, frame->payload);
    ++pings;
    ASSERT_LT(pings, 400);
  }
  EXPECT_GE(pings, 1);
  EXPECT_TRUE(alive.frame());  // and the one that answers stays
  EXPECT_EQ(server.clients(), 1U);
  EXPECT_EQ(dead.frame()->opcode, SocketClient::ping);
  EXPECT_FALSE(dead.message());
}

}  // namespace
}  // namespace telemime
