// SPDX-License-Identifier: Apache-2.0
#include "telemime/streaming/web_connection.h"

#include <boost/asio/buffer.hpp>
#include <boost/beast/http/error.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/write.hpp>
#include <chrono>
#include <utility>

#include "telemime/streaming/web_client.h"

namespace telemime {
namespace {

namespace http = boost::beast::http;
using boost::system::error_code;

// All programs on localhost share their cookies, so headers can be long.
constexpr std::size_t longest_header = 32 * 1024;
constexpr std::chrono::seconds linger_time{2};

}  // namespace

WebConnection::WebConnection(std::shared_ptr<WebHub> hub, std::shared_ptr<void> ticket,
                             boost::asio::ip::tcp::socket socket)
    : hub_(std::move(hub)),
      ticket_(std::move(ticket)),
      stream_(std::move(socket), hub_->tls()),
      patience_(stream_.get_executor()),
      local_(local_address(stream_.socket()).to_string()),
      buffer_(2 * longest_header) {
  error_code ignored;
  stream_.socket().set_option(boost::asio::ip::tcp::no_delay(true), ignored);
}

void WebConnection::start() {
  if (!stream_.secure()) {
    read();
    return;
  }
  stream_.expires_after(hub_->options().request_within);
  stream_.async_handshake([self = shared_from_this()](error_code error) {
    if (!error) {
      self->read();
    }
  });
}

void WebConnection::read() {
  parser_.emplace();
  parser_->header_limit(longest_header);
  parser_->body_limit(hub_->options().most_posted);
  // For the complete request: a client that sends a byte now and then does not extend it.
  stream_.expires_after(hub_->options().request_within);
  http::async_read_header(
      stream_, buffer_, *parser_,
      [self = shared_from_this()](error_code error, std::size_t) { self->answer(error); });
}

void WebConnection::answer(error_code error) {
  static const boost::system::error_category& malformed = make_error_code(http::error::bad_method).category();
  if (error == http::error::header_limit || error == http::error::buffer_overflow) {
    respond(web_refusal(http::status::request_header_fields_too_large, "The request is too long."));
  } else if (error == http::error::body_limit) {
    respond(web_refusal(http::status::payload_too_large, "The body of the request is too long."));
  } else if (error && error != http::error::end_of_stream && error.category() == malformed) {
    respond(web_refusal(http::status::bad_request, "This is not an HTTP request."));
  } else if (WebPost post;
             !error && web_post(parser_->get(), hub_->names(), local_, hub_->handlers(), post)) {
    read_body(std::move(post));
  } else if (!error) {
    std::optional<WebResponse> found =
        web_answer(parser_->get(), !parser_->is_done(), hub_->names(), local_, hub_->handlers());
    if (found) {
      respond(std::move(*found));
    } else {
      upgrade();
    }
  }
}

// Within the same time limit as the header.
void WebConnection::read_body(WebPost post) {
  body_.emplace(std::move(*parser_));
  http::async_read(
      stream_, buffer_, *body_,
      [self = shared_from_this(), post = std::move(post)](error_code error, std::size_t) mutable {
        if (error == http::error::body_limit) {
          self->respond(web_refusal(http::status::payload_too_large, "The body of the request is too long."));
        } else if (!error) {
          post.body = std::move(self->body_->get().body());
          self->ask(std::move(post));
        }
      });
}

void WebConnection::ask(WebPost post) {
  post.address = remote_address(stream_.socket()).to_string();
  // Only the hub keeps this connection alive until the answer or the timeout. It releases it once, so that
  // only the first of the two counts.
  hub_->hold(shared_from_this());
  stream_.expires_never();
  patience_.expires_after(hub_->options().stalled_after);
  patience_.async_wait([weak = weak_from_this()](error_code cancelled) {
    const std::shared_ptr<WebConnection> self = weak.lock();
    if (!cancelled && self && self->hub_->let_go(self)) {
      self->respond(web_refusal(http::status::service_unavailable, "This takes too long. Try again later."));
    }
  });
  const auto ready = [door = hub_->door(), weak = weak_from_this()](const WebContent& content) {
    door->post([weak, content] {
      if (const std::shared_ptr<WebConnection> self = weak.lock()) {
        self->put_content(content);
      }
    });
  };
  try {
    hub_->handlers().post(std::move(post), ready);
  } catch (...) {
    WebContent failure;
    failure.bytes = std::make_shared<const std::string>("The program could not answer this.\n");
    failure.type = "text/plain; charset=utf-8";
    failure.status = static_cast<unsigned>(http::status::internal_server_error);
    ready(failure);
  }
}

void WebConnection::put_content(WebContent content) {
  if (hub_->let_go(shared_from_this())) {
    patience_.cancel();
    respond(web_content(std::move(content), WebRequest(body_->get().base()), hub_->handlers()));
  }
}

void WebConnection::upgrade() {
  if (stream_.secure()) {
    respond(web_refusal(http::status::not_found, "WebSockets are not available at this address."));
    return;
  }
  if (buffer_.size() > 0) {
    respond(web_refusal(http::status::bad_request,
                        "A WebSocket client must wait for the response to its request."));
    return;
  }
  const auto client = std::make_shared<WebClient>(hub_, std::move(ticket_), stream_.take());
  client->start(parser_->get());
}

void WebConnection::respond(WebResponse answer) {
  answer_ = std::move(answer);
  if (hub_->crowded()) {
    answer_.keep_alive(false);
  }
  serializer_.emplace(answer_);
  write();
}

void WebConnection::write() {
  // Restarted for each part: a slow reader is not a stalled one.
  stream_.expires_after(hub_->options().stalled_after);
  http::async_write_some(stream_, *serializer_, [self = shared_from_this()](error_code error, std::size_t) {
    if (error) {
      return;
    }
    if (self->serializer_->is_done()) {
      self->sent();
    } else {
      self->write();
    }
  });
}

void WebConnection::sent() {
  const bool again = answer_.keep_alive();
  serializer_.reset();
  body_.reset();
  answer_ = {};  // closes a file and frees bytes
  if (again) {
    read();
    return;
  }
  stream_.expires_after(linger_time);
  if (stream_.secure()) {
    stream_.async_shutdown([self = shared_from_this()](error_code) {});  // waits for the other side's
    return;
  }
  error_code ignored;
  stream_.socket().shutdown(boost::asio::socket_base::shutdown_send, ignored);
  linger();
}

// Closing while the other side still sends would reset the connection, and the answer would be lost.
void WebConnection::linger() {
  stream_.async_read_some(boost::asio::buffer(rest_),
                          [self = shared_from_this()](error_code error, std::size_t) {
                            if (!error) {
                              self->linger();
                            }
                          });
}

}  // namespace telemime
