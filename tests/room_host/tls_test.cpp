// SPDX-License-Identifier: Apache-2.0
// A room by TLS: page, browsers' broker and trackers' broker with one certificate.
#include <gtest/gtest.h>
#include <openssl/ssl.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/ssl/stream.hpp>
#include <boost/asio/write.hpp>
#include <fstream>

#include "rooms/authority.h"
#include "rooms/feeder.h"
#include "telemime/core/errors.h"
#include "telemime/network/room_entry.h"
#include "visitor.h"

namespace telemime::testing_rooms {
namespace {

namespace asio = boost::asio;

class TlsRoom : public ::testing::Test {
 protected:
  TlsRoom() { authority_.certify("room", "DNS:localhost"); }
  OpenRoom::Change with(const std::string& certificate, const std::string& key) const {
    return [certificate, key](RoomPlan& plan) {
      plan.certificate = certificate;
      plan.key = key;
    };
  }
  OpenRoom::Change secure() const { return with(authority_.file("room.pem"), authority_.file("room.key")); }
  static std::string refusal(const OpenRoom::Change& change) {
    try {
      const OpenRoom room(change);
    } catch (const Error& e) {
      return e.what();
    }
    return "nothing was refused";
  }
  /// What a server at that port answers to a request by TLS, until it closes.
  std::string told(std::uint16_t port, const std::string& request) const {
    asio::io_context io;
    asio::ssl::context tls(asio::ssl::context::tls_client);
    tls.load_verify_file(authority_.file("ca.pem"));
    tls.set_verify_mode(asio::ssl::verify_peer);
    asio::ssl::stream<asio::ip::tcp::socket> stream(io, tls);
    stream.next_layer().connect({asio::ip::address_v4::loopback(), port});
    stream.handshake(asio::ssl::stream_base::client);
    asio::write(stream, asio::buffer(request));
    std::string answer;
    std::array<char, 4096> part{};
    boost::system::error_code error;
    while (!error && answer.find("\r\n\r\n") == std::string::npos) {
      answer.append(part.data(), stream.read_some(asio::buffer(part), error));
    }
    return answer;
  }
  Authority authority_;
};

TEST_F(TlsRoom, AllIsEncryptedWithOneCertificate) {
  OpenRoom room(secure());
  const std::string port = std::to_string(room.host().port());
  EXPECT_EQ(room.host().page(), "https://localhost:" + port + "/room");
  const std::string page = told(
      room.host().port(), "GET /room HTTP/1.1\r\nHost: localhost:" + port + "\r\nConnection: close\r\n\r\n");
  EXPECT_TRUE(page.starts_with("HTTP/1.1 200")) << page;
  EXPECT_NE(page.find(" wss://localhost:" + std::to_string(room.host().web_port()) + ";"), std::string::npos);
  const std::string upgrade =
      told(room.host().web_port(),
           "GET /mqtt HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
           "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: "
           "13\r\nSec-WebSocket-Protocol: mqtt\r\n\r\n");
  EXPECT_TRUE(upgrade.starts_with("HTTP/1.1 101")) << upgrade;
  RawClient plain(room.host().port());
  plain.send(request_text(room.host().port(), "/room"));
  EXPECT_EQ(plain.rest().find("HTTP"), std::string::npos) << "nothing by plain HTTP";
}

TEST_F(TlsRoom, ATrackerComesInByItsLink) {
  OpenRoom room(secure());
  RoomEntry entry;
  entry.link = room.host().speak_link();
  entry.ca = authority_.file("ca.pem");
  const RoomKey key = enter_room(entry);
  EXPECT_EQ(key.broker, "mqtts://localhost:" + std::to_string(room.host().mqtt_port()));
  std::string link = room.host().speak_link();
  link.insert(link.find('#'), "?ca=" + authority_.file("ca.pem"));
  const auto sender = make_sender(link);
  const Feeder feeder(*sender);
  EXPECT_TRUE(comes_true([&] { return sender->status().sent > 5; })) << sender->status().words;
}

TEST_F(TlsRoom, WhoIsNotTrustedIsNotToldTheSecret) {
  OpenRoom room(secure());
  const auto words = [](const RoomEntry& entry) {
    try {
      enter_room(entry);
    } catch (const Error& e) {
      return std::string(e.what());
    }
    return std::string("nothing was refused");
  };
  RoomEntry entry;
  entry.link = room.host().speak_link();
  EXPECT_NE(words(entry).find("signed by nobody who is trusted here"), std::string::npos) << words(entry);
  const Authority other;
  entry.ca = other.file("ca.pem");
  EXPECT_NE(words(entry).find("signed by nobody who is trusted here"), std::string::npos) << words(entry);
  entry.ca = authority_.file("ca.pem");
  entry.link.replace(entry.link.find("localhost"), 9, "127.0.0.1");
  EXPECT_NE(words(entry).find(R"(is not one for "127.0.0.1")"), std::string::npos) << words(entry);
  entry.link.replace(0, 5, "http");
  EXPECT_NE(words(entry), "nothing was refused") << "no way around it";
  EXPECT_EQ(words(entry).find(room.speak()), std::string::npos);
}

TEST_F(TlsRoom, WrongFilesAreToldApart) {
  authority_.certify("other", "DNS:localhost");
  const std::string pem = authority_.file("room.pem");
  const std::string key = authority_.file("room.key");
  std::ofstream(authority_.file("rubbish")) << "rubbish";
  const auto has = [](const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
  };
  EXPECT_TRUE(has(refusal(with(authority_.file("none"), key)), "the certificate cannot be read"));
  EXPECT_TRUE(has(refusal(with(pem, authority_.file("none"))), "the certificate's key cannot be read"));
  EXPECT_TRUE(has(refusal(with(authority_.file("rubbish"), key)), "no certificate to be used"));
  EXPECT_TRUE(has(refusal(with(pem, authority_.file("rubbish"))), "no key to be used"));
  EXPECT_TRUE(has(refusal(with(pem, authority_.file("other.key"))), "is not the key of"));
}

}  // namespace
}  // namespace telemime::testing_rooms
