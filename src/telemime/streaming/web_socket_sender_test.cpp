// SPDX-License-Identifier: Apache-2.0
#include "telemime/streaming/all.h"

#include <gtest/gtest.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <future>
#include <nlohmann/json.hpp>

#include "telemime/outputs/testing_motion.h"
#include "telemime/streaming/sender.h"
#include "telemime/streaming/testing_receivers.h"

namespace telemime {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
using nlohmann::json;
using testing_receivers::comes_true;
using testing_receivers::ends_at_once;
using testing_receivers::kTaken;

/// A WebSocket server for one client at a time.
class Server {
 public:
  std::uint16_t port() const { return acceptor_.local_endpoint().port(); }

  /// Takes the next client; what it asked for.
  std::string accept() {
    stream_.emplace(acceptor_.accept());
    beast::http::request<beast::http::string_body> request;
    beast::flat_buffer buffer;
    beast::http::read(stream_->next_layer(), buffer, request);
    stream_->accept(request);
    return std::string(request.target()) + " " + std::string(request[beast::http::field::host]);
  }
  json read() {
    beast::flat_buffer buffer;
    stream_->read(buffer);
    EXPECT_TRUE(stream_->got_text());
    return json::parse(beast::buffers_to_string(buffer.data()));
  }
  /// The client may hang up in between.
  void write(const std::string& text) {
    boost::system::error_code hung_up;
    stream_->write(asio::buffer(text), hung_up);
  }
  void close() { stream_->close(beast::websocket::close_code::going_away); }
  /// Reads until the client has closed; the code that it gave.
  std::optional<std::uint16_t> code_at_end() {
    boost::system::error_code error;
    while (!error) {
      beast::flat_buffer buffer;
      stream_->read(buffer, error);
    }
    // The client may be gone before its goodbye is answered.
    const std::uint16_t code = stream_->reason().code;
    return code == beast::websocket::close_code::none ? std::nullopt : std::optional(code);
  }

 private:
  asio::io_context io_;
  asio::ip::tcp::acceptor acceptor_{io_, {asio::ip::make_address("127.0.0.1"), 0}};
  std::optional<beast::websocket::stream<asio::ip::tcp::socket>> stream_;
};

class WebSocketSender : public ::testing::Test {
 protected:
  std::unique_ptr<Sender> sender(const std::string& path = "") const {
    return make_sender("ws://127.0.0.1:" + std::to_string(server_.port()) + path);
  }
  Server server_;
  StreamHeader header_ = testing_motion::header();
  std::vector<MotionFrame> frames_ = testing_motion::gesture(header_, 5);
};

TEST_F(WebSocketSender, SendsThePersonAndTheFrames) {
  const auto sender = this->sender("/room/1?mirror=0&key=a1");
  EXPECT_EQ(server_.accept(), "/room/1?key=a1 127.0.0.1:" + std::to_string(server_.port()));
  sender->begin(header_);
  EXPECT_EQ(server_.read()["type"], "body");
  double taken = 5000.25;
  for (const MotionFrame& frame : frames_) {
    sender->send(frame, taken += 40.0);
    const json message = server_.read();
    EXPECT_EQ(message["type"], "pose");
    EXPECT_EQ(message["frame"], frame.frame);
    EXPECT_EQ(message["stamp"].get<double>(), taken) << "when the picture was taken, not when it was sent";
  }
  EXPECT_EQ(sender->status().state, SenderState::sending);
}

TEST_F(WebSocketSender, ThePersonComesFirstAlsoAfterABreakAndAnew) {
  const auto sender = this->sender();
  server_.accept();
  sender->begin(header_);
  EXPECT_EQ(server_.read()["type"], "body");
  sender->send(frames_[0], kTaken);
  const json first = server_.read();
  server_.close();
  server_.accept();
  EXPECT_EQ(server_.read()["type"], "body");
  MotionFrame moved = frames_[0];
  moved.pose.root.x() += 0.1;
  sender->send(moved, kTaken);
  EXPECT_NEAR(server_.read()["hips"][0].get<double>() - first["hips"][0].get<double>(), 0.1, 1e-4)
      << "hips are where they were before the break";
  header_.body = make_body(Shape{1.5, {}, 0.5});
  sender->begin(header_);
  const json person = server_.read();
  EXPECT_EQ(person["type"], "body");
  EXPECT_EQ(person["stature"], 1.5);
}

TEST_F(WebSocketSender, EndsWithTheClosingHandshake) {
  auto sender = this->sender();
  server_.accept();
  sender->begin(header_);
  EXPECT_EQ(server_.read()["type"], "body");
  auto code = std::async(std::launch::async, [this] { return server_.code_at_end(); });
  sender.reset();
  EXPECT_EQ(code.get(), static_cast<std::uint16_t>(beast::websocket::close_code::normal));
}

TEST_F(WebSocketSender, WhatTheReceiverSaysIsReadAndForgotten) {
  const auto sender = this->sender();
  server_.accept();
  sender->begin(header_);
  EXPECT_EQ(server_.read()["type"], "body");
  for (int n = 0; n < 300; ++n) {
    server_.write(std::string(1000, 'x'));
  }
  sender->send(frames_[0], kTaken);
  EXPECT_EQ(server_.read()["type"], "pose");
  server_.write(std::string(100000, 'x'));  // too much: begins again
  server_.accept();
  EXPECT_EQ(server_.read()["type"], "body");
}

TEST_F(WebSocketSender, EndsAtOnceDuringAHandshakeThatIsNeverAnswered) {
  testing_receivers::TcpListener listener;
  auto sender = make_sender("ws://127.0.0.1:" + std::to_string(listener.port()));
  testing_receivers::TcpPeer peer = listener.accept();
  EXPECT_EQ(peer.line().value_or("").substr(0, 6), "GET / ");
  EXPECT_TRUE(ends_at_once(std::move(sender)));
}

TEST_F(WebSocketSender, AnotherKindOfServerIsReported) {
  testing_receivers::TcpListener listener;
  const auto sender = make_sender("ws://127.0.0.1:" + std::to_string(listener.port()) + "/x");
  testing_receivers::TcpPeer peer = listener.accept();
  peer.send("HTTP/1.1 404 Not Found\r\nContent-Length: 0\r\n\r\n");
  EXPECT_TRUE(comes_true([&] { return sender->status().state == SenderState::failed; }));
  EXPECT_EQ(sender->status().words, "it refuses a WebSocket at \"/x\"; trying again");
}

}  // namespace
}  // namespace telemime
