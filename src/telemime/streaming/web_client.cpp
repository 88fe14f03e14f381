// SPDX-License-Identifier: Apache-2.0
#include "telemime/streaming/web_client.h"

#include <algorithm>
#include <boost/asio/buffer.hpp>
#include <chrono>
#include <optional>
#include <utility>

#include "telemime/streaming/web_stream.h"

namespace telemime {
namespace {

namespace beast = boost::beast;
namespace websocket = boost::beast::websocket;
using boost::system::error_code;

// Messages are sent in pieces of this size, so that a slow client can be told from one that has stopped.
constexpr std::size_t piece = 64 * 1024;
// The system's own queue could hold seconds of old images for a slow client.
constexpr int kernel_buffer = 256 * 1024;

}  // namespace

WebClient::WebClient(std::shared_ptr<WebHub> hub, std::shared_ptr<void> ticket, beast::tcp_stream stream)
    : hub_(std::move(hub)),
      ticket_(std::move(ticket)),
      stream_(std::move(stream)),
      stalled_(stream_.get_executor()) {}

WebClient::~WebClient() {
  hub_->leave(id_);
}

void WebClient::start(const WebRequest& request) {
  const WebServerOptions& options = hub_->options();
  error_code ignored;
  beast::tcp_stream& lowest = beast::get_lowest_layer(stream_);
  lowest.expires_never();  // the WebSocket has its own timers
  lowest.socket().set_option(boost::asio::socket_base::send_buffer_size(kernel_buffer), ignored);
  stream_.set_option(websocket::stream_base::timeout{options.request_within, options.stalled_after,
                                                     /*keep_alive_pings=*/true});
  stream_.read_message_max(options.most_bytes_in);
  stream_.auto_fragment(false);
  stream_.async_accept(request, [self = shared_from_this()](error_code error) {
    if (!error) {
      self->opened();
    }
  });
}

void WebClient::opened() {
  const std::optional<std::uint64_t> id =
      hub_->join(shared_from_this(), remote_address(beast::get_lowest_layer(stream_).socket()).is_loopback());
  if (!id) {
    close(Code::try_again_later, "Too many pages are open. Close one.");
    return;
  }
  id_ = *id;
  for (std::string& text : hub_->greeting(id_)) {
    push({0, false, std::make_shared<const std::string>(std::move(text))});
  }
  read();
}

void WebClient::read() {
  if (closing_) {
    return;
  }
  stream_.async_read(buffer_, [self = shared_from_this()](error_code error, std::size_t) {
    // The stream has already reported a message that is too big (1009) or not UTF-8 (1007) to the other side.
    if (error) {
      self->drop();
    } else {
      self->take();
    }
  });
}

void WebClient::take() {
  if (closing_) {
    return;
  }
  if (stream_.got_binary()) {
    close(Code::unknown_data, "Only text messages are supported.");
    return;
  }
  const auto data = buffer_.cdata();
  std::optional<std::string> answer = hub_->answer(id_, {static_cast<const char*>(data.data()), data.size()});
  buffer_.consume(buffer_.size());
  if (answer) {
    push({0, false, std::make_shared<const std::string>(std::move(*answer))});
  }
  read();
}

void WebClient::push(WebMessage message) {
  if (closing_) {
    return;
  }
  if (!queue_.push(std::move(message))) {
    drop();
    return;
  }
  write();
}

void WebClient::write() {
  if (writing_ || closing_) {
    return;
  }
  if (std::optional<WebMessage> next = queue_.pop()) {
    current_ = std::move(*next);
    offset_ = 0;
    writing_ = true;
    write_piece();
  }
}

void WebClient::write_piece() {
  stalled_.expires_after(hub_->options().stalled_after);
  stalled_.async_wait([weak = weak_from_this()](error_code error) {
    const std::shared_ptr<WebClient> self = weak.lock();
    // The next piece may have begun before this call ran.
    if (!error && self && self->writing_ && self->stalled_.expiry() <= std::chrono::steady_clock::now()) {
      self->drop();
    }
  });
  const std::size_t size = std::min(piece, current_.bytes->size() - offset_);
  stream_.binary(current_.binary);
  stream_.async_write_some(offset_ + size == current_.bytes->size(),
                           boost::asio::buffer(current_.bytes->data() + offset_, size),
                           [self = shared_from_this()](error_code error, std::size_t bytes) {
                             if (error) {
                               self->drop();
                             } else {
                               self->written(bytes);
                             }
                           });
}

void WebClient::written(std::size_t bytes) {
  offset_ += bytes;
  if (offset_ < current_.bytes->size() && !closing_) {
    write_piece();
    return;
  }
  stalled_.cancel();
  writing_ = false;
  current_ = {};
  write();
}

void WebClient::close(Code code, const char* words) {
  closing_ = true;
  hub_->leave(id_);
  stream_.async_close({code, words}, [self = shared_from_this()](error_code) { self->drop(); });
}

void WebClient::drop() {
  closing_ = true;
  hub_->leave(id_);
  stalled_.cancel();
  error_code ignored;
  beast::get_lowest_layer(stream_).socket().shutdown(boost::asio::socket_base::shutdown_both, ignored);
  beast::get_lowest_layer(stream_).close();
}

}  // namespace telemime
