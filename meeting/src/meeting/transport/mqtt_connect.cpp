// SPDX-License-Identifier: Apache-2.0
// How a connection comes about, and in words why it does not.
#include <fcntl.h>
#include <mosquitto.h>
#include <sys/socket.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <cerrno>

#include "meeting/transport/mqtt_connection.h"
#include "telemime/streaming/resolve.h"
#include "telemime/streaming/tcp.h"

namespace telemime::meeting {

namespace asio = boost::asio;

namespace {

constexpr std::chrono::milliseconds kLongestConnect{5000};
constexpr int kKeepAlive = 5;           // s
constexpr int kSendBuffer = 16 * 1024;  // bytes
constexpr int kAtLeastOnce = 1;
constexpr const char* kNoBroker = "it does not answer as an MQTT broker does";

/// This address of the host leads nowhere; another one may.
class Unreachable : public LinkBroken {
 public:
  using LinkBroken::LinkBroken;
};

boost::system::error_code system_error(int number) {
  return {number, boost::system::system_category()};
}

// MQTT 3.1.1, 3.2.2.3.
std::string refusal_words(int code, bool named) {
  switch (code) {
    case 1:
      return "it does not speak MQTT 3.1.1";
    case 2:
      return "it does not accept our name";
    case 3:
      return "it takes nobody now";
    case 4:
    case 5:
      return named ? "it refuses the user or the password" : "it wants a user and a password";
    default:
      return "it refuses the connection";
  }
}

}  // namespace

void MqttConnection::open(const std::string& client_id, const std::optional<MqttMessage>& will) {
  std::string cause;
  for (const std::string& address : resolve(loop_, server_.host)) {
    try {
      connect(address, client_id, will);
      return;
    } catch (const Unreachable& e) {  // the first address is the one that most brokers listen at
      cause = cause.empty() ? e.what() : cause;
    }
  }
  throw LinkBroken(cause);
}

void MqttConnection::prepare(const std::string& client_id, const std::optional<MqttMessage>& will) {
  close();
  client_.reset(mosquitto_new(client_id.c_str(), /*clean_session=*/true, this));
  mosquitto* const client = client_.get();
  if (client == nullptr) {
    throw LinkBroken("no connection can be made here");
  }
  mosquitto_connect_callback_set(client, on_connect);
  mosquitto_subscribe_callback_set(client, on_subscribe);
  mosquitto_publish_callback_set(client, on_publish);
  mosquitto_message_callback_set(client, on_message);
  check(mosquitto_int_option(client, MOSQ_OPT_PROTOCOL_VERSION, MQTT_PROTOCOL_V311));
  check(mosquitto_int_option(client, MOSQ_OPT_TCP_NODELAY, 1));
  if (will) {
    check(mosquitto_will_set(client, will->topic.c_str(), static_cast<int>(will->payload.size()),
                             will->payload.data(), kAtLeastOnce, /*retain=*/true));
  }
  if (!server_.user.empty()) {
    check(mosquitto_username_pw_set(client, server_.user.c_str(), server_.password.c_str()));
  }
  if (tls_) {
    tls_->forget();
    check(mosquitto_int_option(client, MOSQ_OPT_SSL_CTX_WITH_DEFAULTS, 0));
    check(mosquitto_void_option(client, MOSQ_OPT_SSL_CTX, tls_->context()));
  }
}

void MqttConnection::connect(const std::string& address, const std::string& client_id,
                             const std::optional<MqttMessage>& will) {
  prepare(client_id, will);
  errno = 0;
  const int result = mosquitto_connect_async(client_.get(), address.c_str(), server_.port, kKeepAlive);
  const int error = errno;
  if (result != MOSQ_ERR_SUCCESS) {
    tell_why_unreachable(address, result, error);
  }
  const int descriptor = ::fcntl(mosquitto_socket(client_.get()), F_DUPFD_CLOEXEC, 0);
  if (descriptor < 0) {
    throw LinkBroken(in_words(system_error(errno)));
  }
  socket_.emplace(loop_.io(), descriptor);
  ::setsockopt(descriptor, SOL_SOCKET, SO_SNDBUF, &kSendBuffer, sizeof kSendBuffer);
  watch_reads();
  watch_writes();
  watch_time();
  if (!loop_.wait([this] { return answer_.has_value() || refused_; }, kLongestConnect)) {
    if (!look_at_socket()) {
      throw Unreachable("no answer from there");
    }
    throw LinkBroken(words_for(MOSQ_ERR_KEEPALIVE, 0));
  }
  if (refused_) {
    tell_why_unreachable(address, MOSQ_ERR_CONN_LOST, 0);
  }
  if (*answer_ != 0) {
    throw LinkBroken(refusal_words(*answer_, !server_.user.empty()));
  }
}

// TLS hides why; a connection without it tells. When that one can be made, what else is known must do.
void MqttConnection::tell_why_unreachable(const std::string& address, int result, int error) {
  reached_ = true;
  const std::string otherwise = words_for(result, error);
  close();
  try {
    asio::ip::tcp::socket probe(loop_.io());
    connect_tcp(loop_, probe, address, server_.port);
  } catch (const LinkBroken& e) {
    throw Unreachable(e.what());
  }
  throw LinkBroken(otherwise);
}

// The first that is heard of the socket is whether it could be connected. False: there is nothing to be read
// or written.
bool MqttConnection::look_at_socket() {
  if (reached_ || refused_) {
    return reached_;
  }
  int error = 0;
  socklen_t size = sizeof error;
  sockaddr_storage peer{};
  socklen_t peer_size = sizeof peer;
  ::getsockopt(socket_->native_handle(), SOL_SOCKET, SO_ERROR, &error, &size);
  const bool broke = error == ECONNRESET || error == EPIPE;
  const bool stands =
      ::getpeername(socket_->native_handle(), reinterpret_cast<sockaddr*>(&peer), &peer_size) == 0;
  reached_ = broke || (error == 0 && stands);
  refused_ = !reached_;
  if (broke) {
    throw LinkBroken(words_for(MOSQ_ERR_CONN_LOST, error));
  }
  return reached_;
}

std::string MqttConnection::words_for(int result, int error) const {
  if (tls_ && !tls_->refusal().empty()) {
    return tls_->refusal();
  }
  if (answer_.value_or(0) != 0) {
    return refusal_words(*answer_, !server_.user.empty());
  }
  if (tls_ && reached_ && !tls_->shaken()) {
    return "no TLS connection comes about; is TLS spoken at that port?";
  }
  const bool broke = result == MOSQ_ERR_ERRNO && (error == ECONNRESET || error == EPIPE);
  switch (broke ? static_cast<int>(MOSQ_ERR_CONN_LOST) : result) {
    case MOSQ_ERR_CONN_LOST:
      return answer_ || tls_ ? "it closed the connection"
                             : "it closed the connection without a word; mqtts:// may be meant";
    case MOSQ_ERR_KEEPALIVE:
      return answer_ ? "it does not answer any more" : kNoBroker;
    case MOSQ_ERR_PROTOCOL:
    case MOSQ_ERR_MALFORMED_PACKET:
      return kNoBroker;
    case MOSQ_ERR_ERRNO:
      return error == EPROTO ? "the TLS connection broke" : in_words(system_error(error));
    default:
      return mosquitto_strerror(result);
  }
}

}  // namespace telemime::meeting
