// SPDX-License-Identifier: Apache-2.0
#include "meeting/hosting/broker_files.h"

#include <gtest/gtest.h>

#include "telemime/core/errors.h"

namespace telemime::meeting {
namespace {

bool has_line(const std::string& text, const std::string& line) {
  return ("\n" + text).find("\n" + line + "\n") != std::string::npos;
}

TEST(BrokerFiles, ConfigurationRequiresAnAccount) {
  BrokerSettings settings;
  settings.folder = "/run/x";
  settings.port = 1884;
  settings.web_port = 9002;
  settings.most_connections = 77;
  const std::string text = broker_configuration(settings);
  for (const char* const line :
       {"allow_anonymous false", "password_file /run/x/passwords", "acl_file /run/x/access",
        "persistence false", "max_packet_size 65536", "listener 0 /run/x/socket", "listener 1884 127.0.0.1",
        "listener 9002 127.0.0.1", "protocol websockets", "socket_domain ipv4", "max_connections 77"}) {
    EXPECT_TRUE(has_line(text, line)) << line << "\n" << text;
  }
  EXPECT_EQ(text.find("certfile"), std::string::npos);
  EXPECT_EQ(text.find("\nuser "), std::string::npos);
}

TEST(BrokerFiles, TlsIsOnBothNetworkListeners) {
  BrokerSettings settings;
  settings.folder = "/run/x";
  settings.certificate = "/etc/room.pem";
  settings.key = "/etc/room.key";
  settings.user = "root";
  const std::string text = broker_configuration(settings);
  EXPECT_TRUE(has_line(text, "user root"));
  const std::size_t first = text.find("certfile /etc/room.pem\nkeyfile /etc/room.key\ntls_version tlsv1.2\n");
  ASSERT_NE(first, std::string::npos) << text;
  EXPECT_NE(text.find("certfile", first + 1), std::string::npos);
  EXPECT_GT(first, text.find("listener 1883"));
}

TEST(BrokerFiles, PathCannotAddALine) {
  BrokerSettings settings;
  settings.folder = "/run/x\nallow_anonymous true";
  EXPECT_THROW(broker_configuration(settings), Error);
}

TEST(BrokerFiles, PasswordsAreHashedWithTheirOwnSalt) {
  const std::string line = password_line("blue.p01", "secret");
  EXPECT_TRUE(line.starts_with("blue.p01:$7$101$")) << line;
  EXPECT_EQ(line.find("secret"), std::string::npos);
  EXPECT_NE(line, password_line("blue.p01", "secret"));
  EXPECT_EQ(line.size(), std::string("blue.p01:$7$101$").size() + 16 + 1 + 88) << line;
}

TEST(BrokerFiles, RulesNameEveryAccount) {
  const std::vector<BrokerAccount> accounts = {
      {"blue.p01", "", {"r/home/blue/#"}, {"r/home/blue/p/p01/pose"}},
      {"blue.watch", "", {"r/home/blue/#"}, {}}};
  EXPECT_EQ(access_rules(accounts),
            "user blue.p01\ntopic read r/home/blue/#\ntopic write r/home/blue/p/p01/pose\n\n"
            "user blue.watch\ntopic read r/home/blue/#\n\n");
}

}  // namespace
}  // namespace telemime::meeting
