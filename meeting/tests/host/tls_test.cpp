// SPDX-License-Identifier: Apache-2.0
// A meeting with TLS: one certificate for the page and both ports of the broker.
#include <gtest/gtest.h>
#include <openssl/ssl.h>
#include <signal.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/ssl/stream.hpp>
#include <boost/asio/write.hpp>
#include <filesystem>
#include <fstream>
#include <thread>

#include "broker/authority.h"
#include "broker/feeder.h"
#include "meeting/protocol/testing.h"
#include "meeting/transport/login.h"
#include "meeting/transport/senders.h"
#include "open_meeting.h"

namespace telemime::meeting::test_support {
namespace {

namespace asio = boost::asio;

/// A server that records what one client sends after the TLS handshake.
class Listener {
 public:
  Listener(const std::string& certificate, const std::string& key) {
    tls_.use_certificate_chain_file(certificate);
    tls_.use_private_key_file(key, asio::ssl::context::pem);
    thread_ = std::thread([this] { listen(); });
  }
  ~Listener() {
    if (thread_.joinable()) {
      thread_.join();
    }
  }
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;
  std::string link(const std::string& host, const std::string& invite) const {
    return "https://" + host + ":" + std::to_string(acceptor_.local_endpoint().port()) + "/room#k=" + invite;
  }
  /// What the client sent, when it has closed.
  const std::string& received() {
    thread_.join();
    return told_;
  }

 private:
  void listen() {
    asio::ssl::stream<asio::ip::tcp::socket> stream(io_, tls_);
    boost::system::error_code error;
    acceptor_.accept(stream.next_layer(), error);
    stream.handshake(asio::ssl::stream_base::server, error);
    std::array<char, 4096> part{};
    // Reads the whole request, then closes without an answer.
    while (!error && told_.find('}') == std::string::npos) {
      told_.append(part.data(), stream.read_some(asio::buffer(part), error));
    }
  }

  asio::io_context io_;
  asio::ip::tcp::acceptor acceptor_{io_, {asio::ip::address_v4::loopback(), 0}};
  asio::ssl::context tls_{asio::ssl::context::tls_server};
  std::string told_;
  std::thread thread_;
};

class TlsMeeting : public ::testing::Test {
 protected:
  TlsMeeting() { authority_.certify("room", "DNS:localhost"); }
  OpenMeeting::Change with(const std::string& certificate, const std::string& key) const {
    return [certificate, key](HostOptions& options) {
      options.certificate = certificate;
      options.key = key;
    };
  }
  OpenMeeting::Change secure() const {
    return with(authority_.file("room.pem"), authority_.file("room.key"));
  }
  static std::string refusal(const OpenMeeting::Change& change) {
    return error_of([&] { const OpenMeeting meeting(change); });
  }
  /// Connects to a server of the authority by TLS, which throws if its certificate is wrong. Sends a request,
  /// if there is one, and returns the head of the answer.
  std::string tls_answer(std::uint16_t port, const std::string& request = "") const {
    asio::io_context io;
    asio::ssl::context tls = trusting();
    asio::ssl::stream<asio::ip::tcp::socket> stream(io, tls);
    stream.next_layer().connect({asio::ip::address_v4::loopback(), port});
    stream.handshake(asio::ssl::stream_base::client);
    asio::write(stream, asio::buffer(request));
    std::string answer;
    std::array<char, 4096> part{};
    boost::system::error_code error;
    while (!request.empty() && !error && answer.find("\r\n\r\n") == std::string::npos) {
      answer.append(part.data(), stream.read_some(asio::buffer(part), error));
    }
    return answer;
  }
  asio::ssl::context trusting() const {
    asio::ssl::context tls(asio::ssl::context::tls_client);
    tls.load_verify_file(authority_.file("ca.pem"));
    tls.set_verify_mode(asio::ssl::verify_peer);
    return tls;
  }
  Authority authority_;
};

TEST_F(TlsMeeting, EverythingUsesOneCertificate) {
  OpenMeeting meeting(secure());
  const std::string port = std::to_string(meeting.host().port());
  EXPECT_EQ(meeting.host().page(), "https://localhost:" + port + "/room");
  const std::string page = tls_answer(meeting.host().port(), "GET /room HTTP/1.1\r\nHost: localhost:" + port +
                                                                 "\r\nConnection: close\r\n\r\n");
  EXPECT_TRUE(page.starts_with("HTTP/1.1 200")) << page;
  EXPECT_NE(page.find(" wss://localhost:" + std::to_string(meeting.host().web_port()) + ";"),
            std::string::npos);
  const std::string upgrade =
      tls_answer(meeting.host().web_port(),
                 "GET /mqtt HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                 "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: "
                 "13\r\nSec-WebSocket-Protocol: mqtt\r\n\r\n");
  EXPECT_TRUE(upgrade.starts_with("HTTP/1.1 101")) << upgrade;
  RawClient plain(meeting.host().port());
  plain.send(request_text(meeting.host().port(), "/room"));
  EXPECT_EQ(plain.rest().find("HTTP"), std::string::npos) << "nothing by plain HTTP";
}

TEST_F(TlsMeeting, TrackerLogsInByLink) {
  OpenMeeting meeting(secure());
  LinkLogin entry;
  entry.link = meeting.host().speak_link();
  entry.ca = authority_.file("ca.pem");
  const Credentials key = log_in_by_link(entry);
  EXPECT_EQ(key.broker, "mqtts://localhost:" + std::to_string(meeting.host().mqtt_port()));
  std::string link = meeting.host().speak_link();
  link.insert(link.find('#'), "?ca=" + authority_.file("ca.pem"));
  const auto sender = make_sender(link, kAllSenderKinds);
  const Feeder feeder(*sender);
  EXPECT_TRUE(comes_true([&] { return sender->status().sent > 5; })) << sender->status().words;
}

std::string login_error(const LinkLogin& login) {
  return error_of([&] { log_in_by_link(login); });
}

TEST_F(TlsMeeting, UntrustedServerNeverGetsTheSecret) {
  const std::string secret = "a-secret-of-this-room";
  const std::string nobody = "not signed by a trusted authority";
  const Authority other;
  struct Case {
    std::string host;
    std::filesystem::path ca;  ///< trusted by the client; empty: the system's authorities
    std::string text;
  };
  for (const Case& one :
       std::vector<Case>{{"localhost", "", nobody},
                         {"localhost", other.file("ca.pem"), nobody},
                         {"127.0.0.1", authority_.file("ca.pem"), R"(not valid for "127.0.0.1")"}}) {
    Listener listener(authority_.file("room.pem"), authority_.file("room.key"));
    LinkLogin entry;
    entry.link = listener.link(one.host, secret);
    entry.ca = one.ca;
    const std::string text = login_error(entry);
    EXPECT_NE(text.find(one.text), std::string::npos) << text;
    EXPECT_EQ(text.find(secret), std::string::npos) << text;
    EXPECT_EQ(listener.received(), "");
  }
  Listener trusted(authority_.file("room.pem"), authority_.file("room.key"));
  LinkLogin entry;
  entry.link = trusted.link("localhost", secret);
  entry.ca = authority_.file("ca.pem");
  const std::string text = login_error(entry);
  EXPECT_EQ(text.find(secret), std::string::npos) << text;
  EXPECT_NE(trusted.received().find(secret), std::string::npos) << "a trusted server gets it";
}

// A link with http sends the secret unencrypted, but the server does not accept it.
TEST_F(TlsMeeting, LinkWithoutTlsIsRejected) {
  OpenMeeting meeting(secure());
  LinkLogin entry;
  entry.link = meeting.host().speak_link();
  entry.link.replace(0, 5, "http");
  const std::string text = login_error(entry);
  EXPECT_NE(text.find("cannot be joined"), std::string::npos) << text;
  EXPECT_EQ(text.find(meeting.speak()), std::string::npos) << text;
}

TEST_F(TlsMeeting, CertificateStaysUntilTheMeetingIsClosed) {
  OpenMeeting meeting(secure());
  namespace fs = std::filesystem;
  fs::resize_file(authority_.file("room.pem"), 0);
  fs::remove(authority_.file("room.key"));
  const auto handshakes = [&] {
    LinkLogin entry;
    entry.link = meeting.host().speak_link();
    entry.ca = authority_.file("ca.pem");
    log_in_by_link(entry);  // the broker has read its files again
    for (const std::uint16_t port :
         {meeting.host().port(), meeting.host().mqtt_port(), meeting.host().web_port()}) {
      tls_answer(port);
    }
  };
  EXPECT_NO_THROW(handshakes());
  const pid_t before = meeting.host().broker();
  ASSERT_EQ(::kill(before, SIGKILL), 0);
  ASSERT_TRUE(comes_true([&] { return meeting.host().broker() > 0 && meeting.host().broker() != before; }));
  EXPECT_NO_THROW(handshakes()) << meeting.reports();
}

TEST_F(TlsMeeting, WrongFilesAreDistinguished) {
  authority_.certify("other", "DNS:localhost");
  const std::string pem = authority_.file("room.pem");
  const std::string key = authority_.file("room.key");
  std::ofstream(authority_.file("rubbish")) << "rubbish";
  EXPECT_TRUE(contains(refusal(with(authority_.file("none"), key)), "the certificate cannot be read"));
  EXPECT_TRUE(contains(refusal(with(pem, authority_.file("none"))), "the certificate's key cannot be read"));
  EXPECT_TRUE(contains(refusal(with(authority_.file("rubbish"), key)), "no usable certificate"));
  EXPECT_TRUE(contains(refusal(with(pem, authority_.file("rubbish"))), "no usable key"));
  EXPECT_TRUE(contains(refusal(with(pem, authority_.file("other.key"))), "is not the key of"));
}

}  // namespace
}  // namespace telemime::meeting::test_support
