// SPDX-License-Identifier: Apache-2.0
#include "telemime/streaming/all.h"

#include <boost/asio/io_context.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <optional>
#include <string>

#include "telemime/streaming/pose_message.h"
#include "telemime/streaming/send_queue.h"
#include "telemime/streaming/tcp.h"

namespace telemime {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;

constexpr std::chrono::milliseconds kLongestHandshake{5000};
constexpr std::size_t kLongestIncoming = 64 * 1024;  // bytes of a message; all are discarded

/// Path and query as the receiver gets them.
std::string target_of(const SendUrl& url) {
  std::string target = url.path;
  char mark = '?';
  for (const auto& [name, value] : url.options) {
    if (name != "mirror") {
      target.append(1, mark).append(name).append("=").append(value);
      mark = '&';
    }
  }
  return target;
}

class WebSocketLink final : public Link {
 public:
  WebSocketLink(SendLoop& loop, const SendUrl& url)
      : loop_(loop), host_(url.host), port_(url.port.value_or(kHttpPort)), target_(target_of(url)) {}

  void open() override {
    stream_.emplace(loop_.io());
    connect_tcp(loop_, stream_->next_layer(), host_, port_);
    stream_->read_message_max(kLongestIncoming);
    stream_->text(true);
    const auto shaken = std::make_shared<Completion>();
    stream_->async_handshake(host_and_port(host_, port_), target_, note<>(shaken));
    if (!loop_.wait([&] { return shaken->done; }, kLongestHandshake)) {
      throw LinkBroken("it does not answer like a WebSocket server");
    }
    if (shaken->error) {
      throw LinkBroken(shaken->error == beast::websocket::error::upgrade_declined
                           ? "it refuses a WebSocket at \"" + target_ + "\""
                           : in_words(shaken->error));
    }
    read_on();
    loop_.sending();
  }

  void person(const std::shared_ptr<const StreamHeader>& person) override {
    if (person_ != person) {
      messages_.emplace(*person);
      person_ = person;
    }
    write(messages_->body());
  }

  bool frame(const MotionFrame& frame, double taken) override {
    write(messages_->pose(frame, taken));
    return true;
  }

  void close() noexcept override {
    if (stream_) {
      say_goodbye();
      boost::system::error_code ignored;
      stream_->next_layer().close(ignored);
    }
  }

 private:
  using Stream = beast::websocket::stream<asio::ip::tcp::socket>;

  /// The closing handshake (RFC 6455, section 7), without SendLoop::wait(), which throws when the sender
  /// ends.
  void say_goodbye() noexcept {
    constexpr std::chrono::milliseconds kLongestGoodbye(200);
    if (!stream_->is_open()) {
      return;
    }
    try {
      const auto closed = std::make_shared<Completion>();
      stream_->async_close(beast::websocket::close_code::normal, note<>(closed));
      const auto end = std::chrono::steady_clock::now() + kLongestGoodbye;
      while (!closed->done && loop_.io().run_one_until(end) > 0) {
      }
    } catch (const std::exception&) {  // the connection is broken: nobody waits for a goodbye
      return;
    }
  }

  void write(std::string message) {
    const auto text = std::make_shared<const std::string>(std::move(message));
    const auto written = std::make_shared<Completion>();
    stream_->async_write(asio::buffer(*text), [text, done = note<std::size_t>(written)](
                                                  const boost::system::error_code& error, std::size_t count) {
      done(error, count);
    });
    finish_write(loop_, *written);
  }

  /// Reading is what answers the receiver's pings and notices that it has closed.
  void read_on() {
    stream_->async_read(incoming_, [this](const boost::system::error_code& error, std::size_t /*count*/) {
      incoming_.clear();
      if (error == asio::error::operation_aborted) {
        return;
      }
      if (error) {
        throw LinkBroken(error == beast::websocket::error::closed ? "it closed the connection"
                                                                  : in_words(error));
      }
      read_on();
    });
  }

  SendLoop& loop_;
  const std::string host_;
  const std::uint16_t port_;
  const std::string target_;
  std::optional<PoseMessages> messages_;
  std::shared_ptr<const StreamHeader> person_;  ///< of messages_
  beast::flat_buffer incoming_;
  std::optional<Stream> stream_;
};

}  // namespace

std::unique_ptr<Sender> make_web_socket_sender(const SendUrl& url) {
  return make_queued_sender(url, [&](SendLoop& loop) { return std::make_unique<WebSocketLink>(loop, url); });
}

}  // namespace telemime
