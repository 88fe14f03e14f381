// SPDX-License-Identifier: Apache-2.0
#include "telemime/streaming/web_server.h"

#include <atomic>
#include <boost/asio/dispatch.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <exception>
#include <list>
#include <thread>
#include <utility>

#include "telemime/streaming/web_hub.h"
#include "telemime/streaming/web_listener.h"
#include "telemime/streaming/web_stream.h"

namespace telemime {

struct WebServer::State {
  State(const WebServerOptions& options, WebHandlers handlers) {
    std::vector<boost::asio::ip::tcp::acceptor> acceptors = listen_at(io, options.address, options.port);
    port = acceptors.front().local_endpoint().port();
    const bool secure = !options.certificate.empty();
    hub = std::make_shared<WebHub>(options, std::move(handlers), WebNames(port, options.hosts, secure),
                                   std::make_shared<WebDoor>(io),
                                   secure ? web_tls(options.certificate, options.key) : nullptr);
    for (boost::asio::ip::tcp::acceptor& acceptor : acceptors) {
      listeners.emplace_back(hub, std::move(acceptor)).accept();
    }
  }

  void run() {
    while (!io.stopped()) {
      try {
        io.run();
      } catch (const std::exception&) {  // NOLINT(bugprone-empty-catch): out of memory
        // The operation that threw is gone, and with it its connection; the others continue.
      }
    }
  }

  void send(WebMessage message) {
    if (message.bytes && !stopped && hub->put(std::move(message))) {
      boost::asio::post(io, [this] { hub->drain(); });
    }
  }

  std::shared_ptr<WebHub> hub;
  boost::asio::io_context io{1};
  std::list<WebListener> listeners;
  std::uint16_t port = 0;
  std::atomic<bool> stopped = false;
  std::thread thread;
};

WebServer::WebServer(WebServerOptions options, WebHandlers handlers)
    : state_(std::make_unique<State>(options, std::move(handlers))) {
  state_->thread = std::thread([state = state_.get()] { state->run(); });
}

WebServer::~WebServer() {
  stop();
}

void WebServer::stop() {
  if (state_->stopped.exchange(true)) {
    return;
  }
  // All connections end with the io_context.
  boost::asio::post(state_->io, [state = state_.get()] {
    state->hub->leave_all();
    state->io.stop();
  });
  state_->thread.join();
  state_->hub->door()->close();
}

bool WebServer::from_here(std::uint64_t client) const {
  return state_->hub->from_here(client);
}

std::uint16_t WebServer::port() const {
  return state_->port;
}

std::size_t WebServer::clients() const {
  return state_->hub->clients();
}

bool WebServer::wanted(int topic) const {
  return state_->hub->wanted(topic);
}

void WebServer::send_text(int topic, std::shared_ptr<const std::string> text) {
  state_->send({topic, false, std::move(text)});
}

void WebServer::send_binary(int topic, std::shared_ptr<const std::string> bytes) {
  state_->send({topic, true, std::move(bytes)});
}

void WebServer::set_topic(std::uint64_t client, int topic, bool on) {
  // In a handler at once, so that it holds for the client's next message.
  boost::asio::dispatch(
      state_->io, [state = state_.get(), client, topic, on] { state->hub->set_topic(client, topic, on); });
}

}  // namespace telemime
