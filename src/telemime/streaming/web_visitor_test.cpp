// SPDX-License-Identifier: Apache-2.0
// Who is connected, from where, and that handlers may use the server until it has stopped.
#include <gtest/gtest.h>
#include <ifaddrs.h>
#include <net/if.h>

#include <atomic>

#include "telemime/streaming/testing_web.h"
#include "telemime/streaming/testing_web_socket.h"

namespace telemime {
namespace {

// An IPv4 address of this machine that is not loopback; empty when there is none.
std::string address_outside() {
  ifaddrs* all = nullptr;
  if (::getifaddrs(&all) != 0) {
    return "";
  }
  std::string found;
  for (const ifaddrs* one = all; one != nullptr; one = one->ifa_next) {
    const bool usable = (one->ifa_flags & IFF_UP) != 0 && (one->ifa_flags & IFF_LOOPBACK) == 0 &&
                        one->ifa_addr != nullptr && one->ifa_addr->sa_family == AF_INET;
    if (usable) {
      char text[INET_ADDRSTRLEN] = {};
      ::inet_ntop(AF_INET, &reinterpret_cast<const sockaddr_in*>(one->ifa_addr)->sin_addr, text, sizeof text);
      found = text;
    }
  }
  ::freeifaddrs(all);
  return found;
}

/// Handlers that note the last client.
WebHandlers notes_client(std::atomic<std::uint64_t>& id) {
  WebHandlers handlers = small_page();
  handlers.opened = [&id](std::uint64_t client) {
    id = client;
    return std::vector<std::string>();
  };
  return handlers;
}

TEST(WebVisitor, OverLoopbackIsFromHere) {
  std::atomic<std::uint64_t> id = 0;
  const WebServer server(any_port(), notes_client(id));
  EXPECT_FALSE(server.from_here(1)) << "nobody has come";
  {
    const SocketClient page(server.port());
    ASSERT_TRUE(comes_true([&] { return id > 0; }));
    EXPECT_TRUE(server.from_here(id));
    EXPECT_FALSE(server.from_here(id + 1));
  }
  EXPECT_TRUE(comes_true([&] { return !server.from_here(id); }));
}

TEST(WebVisitor, OverAnotherAddressIsNot) {
  const std::string outside = address_outside();
  if (outside.empty()) {
    GTEST_SKIP() << "this machine has no address but loopback";
  }
  WebServerOptions options = any_port();
  options.address = "0.0.0.0";
  std::atomic<std::uint64_t> id = 0;
  const WebServer server(options, notes_client(id));
  const SocketClient page(server.port(), "", 0, outside.c_str());
  ASSERT_TRUE(comes_true([&] { return id > 0; }));
  EXPECT_FALSE(server.from_here(id));
}

TEST(WebVisitor, HandlersMayUseTheServerUntilItHasStopped) {
  std::unique_ptr<WebServer> server;
  std::atomic<int> told = 0;
  WebHandlers handlers = small_page();
  handlers.text = [&](std::uint64_t client, std::string_view) -> std::optional<std::string> {
    server->set_topic(client, 1, false);
    server->send_text(0, shared("one has said something"));
    told += server->port() > 0 ? 1 : 0;
    return std::nullopt;
  };
  server = std::make_unique<WebServer>(any_port(), handlers);
  const SocketClient one(server->port());
  const SocketClient two(server->port());
  ASSERT_TRUE(comes_true([&] { return server->clients() == 2; }));
  one.say("1");
  ASSERT_TRUE(comes_true([&] { return told == 1; }));
  two.say("2");  // perhaps heard while the server ends
  server->stop();
  EXPECT_EQ(server->clients(), 0U);
  server->send_text(0, shared("to nobody"));
  server->set_topic(1, 1, true);
  server->stop();
}

}  // namespace
}  // namespace telemime
