// SPDX-License-Identifier: Apache-2.0
#include "telemime/streaming/web_connection.h"

#include <algorithm>
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

// All programs of localhost share their cookies, so that headers can be long.
constexpr std::size_t longest_header = 32 * 1024;
constexpr std::chrono::seconds linger_time{2};
// Of a file: what is read at a time, between which others have their turn.
constexpr std::size_t longest_part = 128 * 1024;

std::string address_of(const boost::asio::ip::tcp::endpoint& endpoint) {
  const boost::asio::ip::address address = endpoint.address();
  if (address.is_v6() && address.to_v6().is_v4_mapped()) {
    return make_address_v4(boost::asio::ip::v4_mapped, address.to_v6()).to_string();
  }
  return address.to_string();
}

std::string local_address(const boost::asio::ip::tcp::socket& socket) {
  error_code error;
  const boost::asio::ip::tcp::endpoint endpoint = socket.local_endpoint(error);
  return error ? std::string() : address_of(endpoint);
}

std::string remote_address(const boost::asio::ip::tcp::socket& socket) {
  error_code error;
  const boost::asio::ip::tcp::endpoint endpoint = socket.remote_endpoint(error);
  return error ? std::string() : address_of(endpoint);
}

}  // namespace

WebConnection::WebConnection(std::shared_ptr<WebHub> hub, std::shared_ptr<void> ticket,
                             boost::asio::ip::tcp::socket socket)
    : hub_(std::move(hub)),
      ticket_(std::move(ticket)),
      stream_(std::move(socket), hub_->tls()),
      patience_(stream_.get_executor()),
      local_(local_address(stream_.socket())),
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
  // For the whole of it: a client that sends a byte now and then does not put this off.
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
    respond(web_refusal(http::status::bad_request, "This is no HTTP request."));
  } else if (WebPost post;
             !error && web_post(parser_->get(), hub_->names(), local_, hub_->handlers(), post)) {
    read_body(std::move(post));
  } else if (!error) {
    WebAnswer found =
        web_answer(parser_->get(), !parser_->is_done(), hub_->names(), local_, hub_->handlers());
    if (found.upgrade) {
      upgrade();
    } else {
      respond(std::move(found));
    }
  }
}

// Within the time of its header.
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
  post.address = remote_address(stream_.socket());
  hold();
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

void WebConnection::upgrade() {
  if (stream_.secure()) {
    respond(web_refusal(http::status::not_found, "There are no WebSockets here."));
    return;
  }
  if (buffer_.size() > 0) {
    respond(web_refusal(http::status::bad_request, "A WebSocket must wait for the answer to its request."));
    return;
  }
  const auto client = std::make_shared<WebClient>(hub_, std::move(ticket_), stream_.take());
  client->start(parser_->get());
}

void WebConnection::respond(WebAnswer answer) {
  answer_ = std::move(answer);
  if (answer_.later) {
    wait();
  } else {
    write();
  }
}

void WebConnection::hold() {
  // Nobody else keeps this connection while nothing is under way. The hub knows by it, too, whether the
  // answer or the end of patience was first.
  hub_->hold(shared_from_this());
  stream_.expires_never();
  patience_.expires_after(hub_->options().stalled_after);
  patience_.async_wait([weak = weak_from_this()](error_code cancelled) {
    const std::shared_ptr<WebConnection> self = weak.lock();
    if (!cancelled && self && self->hub_->let_go(self)) {
      self->answer_.refuse(http::status::service_unavailable, "This takes too long. Try again later.");
      self->write();
    }
  });
}

void WebConnection::put_bytes(WebBytes bytes) {
  if (hub_->let_go(shared_from_this())) {
    patience_.cancel();
    answer_.finish(std::move(bytes));
    write();
  }
}

void WebConnection::put_content(WebContent content) {
  if (hub_->let_go(shared_from_this())) {
    patience_.cancel();
    answer_ = web_content(std::move(content), WebRequest(body_->get().base()), hub_->handlers());
    write();
  }
}

void WebConnection::wait() {
  hold();
  const auto ready = [door = hub_->door(), weak = weak_from_this()](const WebBytes& bytes) {
    door->post([weak, bytes] {
      if (const std::shared_ptr<WebConnection> self = weak.lock()) {
        self->put_bytes(bytes);
      }
    });
  };
  try {
    std::exchange(answer_.later, nullptr)(ready);
  } catch (...) {
    ready(nullptr);
  }
}

void WebConnection::write() {
  if (hub_->crowded()) {
    answer_.message.keep_alive(false);
  }
  serializer_.emplace(answer_.message);
  write_some();
}

void WebConnection::write_some() {
  stream_.expires_after(
      hub_->options().stalled_after);  // restarted for each part: a slow reader has not stalled
  http::async_write_some(stream_, *serializer_, [self = shared_from_this()](error_code error, std::size_t) {
    if (error) {
      return;
    }
    if (!self->serializer_->is_done()) {
      self->write_some();
    } else {
      self->send_file();
    }
  });
}

void WebConnection::send_file() {
  if (answer_.left == 0) {
    sent();
    return;
  }
  part_.resize(static_cast<std::size_t>(std::min<std::uint64_t>(longest_part, answer_.left)));
  part_.resize(answer_.file->read(answer_.first, part_));
  part_sent_ = 0;
  if (part_.empty()) {
    stream_.close();  // the file was cut short, or the disk fails: not what was promised, and the end says so
    return;
  }
  answer_.first += part_.size();
  answer_.left -= part_.size();
  send_part();
}

void WebConnection::send_part() {
  stream_.expires_after(hub_->options().stalled_after);
  stream_.async_write_some(boost::asio::buffer(part_.data() + part_sent_, part_.size() - part_sent_),
                           [self = shared_from_this()](error_code error, std::size_t count) {
                             if (error) {
                               return;
                             }
                             self->part_sent_ += count;
                             if (self->part_sent_ < self->part_.size()) {
                               self->send_part();
                             } else {
                               self->send_file();
                             }
                           });
}

void WebConnection::sent() {
  const bool again = answer_.message.keep_alive();
  serializer_.reset();
  body_.reset();
  answer_ = {};  // a file is closed, big bytes are let go
  part_ = {};
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
