// SPDX-License-Identifier: Apache-2.0
#include "telemime/streaming/all.h"

#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/write.hpp>
#include <string>

#include "telemime/core/errors.h"
#include "telemime/outputs/all.h"
#include "telemime/streaming/send_queue.h"
#include "telemime/streaming/tcp.h"

namespace telemime {
namespace {

namespace asio = boost::asio;

class BapTcpLink final : public Link {
 public:
  BapTcpLink(SendLoop& loop, const SendUrl& url, const std::string& profile)
      : loop_(loop),
        host_(url.host),
        port_(url.port.value()),
        encoder_(make_bap_encoder(profile)),
        socket_(loop.io()) {}

  void open() override {
    connect_tcp(loop_, socket_, host_, port_);
    header_sent_ = false;
    read_on();
    loop_.sending();
  }

  void person(const std::shared_ptr<const StreamHeader>& person) override {
    if (!header_sent_) {  // it does not depend on the person; a reader expects only one
      write(encoder_->begin(*person));
      header_sent_ = true;
    }
  }

  bool frame(const MotionFrame& frame, double /*taken*/) override {
    write(encoder_->frame(frame));
    return true;
  }

  void close() noexcept override {
    boost::system::error_code ignored;
    socket_.close(ignored);
  }

 private:
  void write(std::string bytes) {
    const auto text = std::make_shared<const std::string>(std::move(bytes));
    const auto written = std::make_shared<Completion>();
    asio::async_write(socket_, asio::buffer(*text),
                      [text, done = note<std::size_t>(written)](const boost::system::error_code& error,
                                                                std::size_t count) { done(error, count); });
    finish_write(loop_, *written);
  }

  /// Reads and discards incoming data, so that a reset is noticed at once. Its end is not a failure: a
  /// receiver may close its own direction only.
  void read_on() {
    socket_.async_read_some(
        asio::buffer(rubbish_), [this](const boost::system::error_code& error, std::size_t /*count*/) {
          if (!error) {
            read_on();
          } else if (error != asio::error::eof && error != asio::error::operation_aborted) {
            throw LinkBroken(in_words(error));
          }
        });
  }

  SendLoop& loop_;
  const std::string host_;
  const std::uint16_t port_;
  const std::unique_ptr<Encoder> encoder_;
  bool header_sent_ = false;
  asio::ip::tcp::socket socket_;
  std::array<char, 512> rubbish_{};
};

}  // namespace

std::unique_ptr<Sender> make_bap_tcp_sender(const SendUrl& url) {
  check_options(url, {"profile", "mirror"});
  if (!url.port || url.path.size() > 1) {
    throw Error(ErrorKind::usage, "the output \"" + url.text + "\" does not name a port",
                "Write it like bap+tcp://localhost:5000.");
  }
  const std::string profile = find_option(url, "profile").value_or("iso");
  make_bap_encoder(profile);  // rejects an unknown profile now, not in the thread
  return make_queued_sender(url,
                            [&](SendLoop& loop) { return std::make_unique<BapTcpLink>(loop, url, profile); });
}

}  // namespace telemime
