// SPDX-License-Identifier: Apache-2.0
#include "telemime/streaming/bap_serve.h"

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <string>
#include <vector>

#include "telemime/core/errors.h"
#include "telemime/outputs/encoders/bap.h"
#include "telemime/streaming/bap_client.h"
#include "telemime/streaming/resolve.h"
#include "telemime/streaming/send_queue.h"
#include "telemime/streaming/tcp.h"

namespace telemime {
namespace {

namespace asio = boost::asio;

/// Lines as VREng's server sends them: its clients part words at blanks alone.
std::string on_one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

class BapServeLink final : public Link {
 public:
  BapServeLink(SendLoop& loop, const SendUrl& url, std::string profile)
      : loop_(loop),
        host_(url.host.empty() ? "127.0.0.1" : url.host),
        port_(url.port.value_or(kVapsPort)),
        profile_(std::move(profile)),
        encoder_(make_bap_encoder(profile_)),
        acceptor_(loop.io()) {}

  void open() override {
    const asio::ip::tcp::endpoint endpoint(asio::ip::make_address(resolve(loop_, host_).front()), port_);
    boost::system::error_code error;
    acceptor_.open(endpoint.protocol(), error);
    if (!error) {
      acceptor_.set_option(asio::socket_base::reuse_address(true), error);
    }
    if (!error) {
      acceptor_.bind(endpoint, error);
    }
    if (!error) {
      acceptor_.listen(asio::socket_base::max_listen_connections, error);
    }
    if (error) {
      throw LinkBroken("cannot listen at " + host_and_port(host_, port_) + ": " + in_words(error));
    }
    address_ = host_and_port(host_, acceptor_.local_endpoint().port());
    report();
    accept();
  }

  void person(const std::shared_ptr<const StreamHeader>& person) override {
    header_ = *person;
    for (const auto& client : clients_) {
      if (client->playing()) {
        send_header(*client);
      }
    }
  }

  bool frame(const MotionFrame& frame, double /*taken*/) override {
    const std::string datagram = on_one_line(encoder_->frame(frame));
    bool sent = false;
    for (const auto& client : clients_) {
      if (client->playing() && client->due(frame.time, header_.fps)) {
        sent = client->send(datagram) || sent;
      }
    }
    report();
    return sent;
  }

  void close() noexcept override {
    boost::system::error_code ignored;
    acceptor_.close(ignored);
    for (const auto& client : clients_) {
      if (client->playing()) {
        client->send({});
      }
      client->close();
    }
    clients_.clear();
  }

 private:
  void accept() {
    acceptor_.async_accept([this](const boost::system::error_code& error, asio::ip::tcp::socket socket) {
      if (error == asio::error::operation_aborted) {
        return;
      }
      if (error) {  // out of file descriptors, say: begin anew, after a pause
        throw LinkBroken("cannot take clients: " + in_words(error));
      }
      report();  // forgets those that have gone
      if (clients_.size() < kMostBapClients) {
        const auto client = std::make_shared<BapClient>(
            std::move(socket), [this](BapClient& one, bool plays) { changed(one, plays); });
        clients_.push_back(client);
        client->read_on();
        report();
      }
      accept();
    });
  }

  void changed(BapClient& client, bool plays) {
    if (!acceptor_.is_open()) {
      return;  // what a closed connection had still to say
    }
    if (plays) {
      send_header(client);
    }
    report();
  }

  /// The rate in it is the one that this client gets.
  void send_header(BapClient& client) const {
    StreamHeader header = header_;
    if (client.rate() > 0.0) {
      header.fps = std::min(header.fps, client.rate());
    }
    client.send(on_one_line(make_bap_encoder(profile_)->begin(header)));
  }

  void report() {
    clients_.erase(std::remove_if(clients_.begin(), clients_.end(),
                                  [](const auto& client) { return !client->connected(); }),
                   clients_.end());
    const auto playing =
        std::count_if(clients_.begin(), clients_.end(), [](const auto& client) { return client->playing(); });
    loop_.sending("listens at " + address_ +
                  (playing == 0 ? ", nobody plays" : ", " + std::to_string(playing) + " playing"));
    loop_.receivers(playing);
  }

  SendLoop& loop_;
  const std::string host_;
  const std::uint16_t port_;
  const std::string profile_;
  const std::unique_ptr<Encoder> encoder_;
  StreamHeader header_;
  std::string address_;
  asio::ip::tcp::acceptor acceptor_;
  std::vector<std::shared_ptr<BapClient>> clients_;
};

}  // namespace

std::unique_ptr<Sender> make_bap_serve_sender(const SendUrl& url) {
  check_options(url, {"profile", "mirror"});
  if (url.path.size() > 1) {
    throw Error(ErrorKind::usage, "the output \"" + url.text + "\" has a path, which means nothing here",
                "Write it like bap+serve://:4150.");
  }
  const std::string profile = free_option(url, "profile").value_or("vreng-3.1");
  make_bap_encoder(profile);  // refuses an unknown one now, not in the thread
  return make_queued_sender(
      url, [&](SendLoop& loop) { return std::make_unique<BapServeLink>(loop, url, profile); });
}

}  // namespace telemime
