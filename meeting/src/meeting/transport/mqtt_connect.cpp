// SPDX-License-Identifier: Apache-2.0
// Opening a connection, and the reasons why that fails.
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
constexpr const char* kNoBroker = "it does not answer like an MQTT broker";

/// This address of the host cannot be reached; another one may.
class Unreachable : public LinkBroken {
 public:
  using LinkBroken::LinkBroken;
};

boost::system::error_code system_error(int number) {
  return {number, boost::system::system_category()};
}

// MQTT 3.1.1, 3.2.2.3.
std::string refusal_reason(int code, bool named) {
  switch (code) {
    case 1:
      return "it does not speak MQTT 3.1.1";
    case 2:
      return "it rejects the client id";
    case 3:
      return "it is not available now";
    case 4:
    case 5:
      return named ? "it rejects the user name or password" : "it requires a user name and password";
    default:
      return "it rejects the connection";
  }
}

}  // namespace

void MqttConnection::open(const std::string& client_id, const std::optional<MqttMessage>& will) {
  std::string cause;
  for (const std::string& address : resolve(loop_, server_.host)) {
    try {
      connect(address, client_id, will);
      return;
    } catch (const Unreachable& e) {  // most brokers listen at the first address
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
    throw LinkBroken("no MQTT client can be created");
  }
  mosquitto_connect_callback_set(client, on_connect);
  mosquitto_subscribe_callback_set(client, on_subscribe);
  mosquitto_publish_callback_set(client, on_publish);
  mosquitto_message_callback_set(client, on_incoming);
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
    tls_->reset();
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
    report_unreachable(address, result, error);
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
    if (!check_socket()) {
      throw Unreachable("it does not respond");
    }
    throw LinkBroken(reason(MOSQ_ERR_KEEPALIVE, 0));
  }
  if (refused_) {
    report_unreachable(address, MOSQ_ERR_CONN_LOST, 0);
  }
  if (*answer_ != 0) {
    throw LinkBroken(refusal_reason(*answer_, !server_.user.empty()));
  }
}

// TLS hides the reason; a plain TCP connection shows it. If that one succeeds, the TLS result is reported.
void MqttConnection::report_unreachable(const std::string& address, int result, int error) {
  reached_ = true;
  const std::string tls_reason = reason(result, error);
  close();
  try {
    asio::ip::tcp::socket probe(loop_.io());
    connect_tcp(loop_, probe, address, server_.port);
  } catch (const LinkBroken& e) {
    throw Unreachable(e.what());
  }
  throw LinkBroken(tls_reason);
}

// The first event of the socket tells whether it is connected. Returns false when nothing can be read or
// written.
bool MqttConnection::check_socket() {
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
    throw LinkBroken(reason(MOSQ_ERR_CONN_LOST, error));
  }
  return reached_;
}

std::string MqttConnection::reason(int result, int error) const {
  if (tls_ && !tls_->refusal().empty()) {
    return tls_->refusal();
  }
  if (answer_.value_or(0) != 0) {
    return refusal_reason(*answer_, !server_.user.empty());
  }
  if (tls_ && reached_ && !tls_->established()) {
    return kNoTls;
  }
  const bool broke = result == MOSQ_ERR_ERRNO && (error == ECONNRESET || error == EPIPE);
  switch (broke ? static_cast<int>(MOSQ_ERR_CONN_LOST) : result) {
    case MOSQ_ERR_CONN_LOST:
      return answer_ || tls_ ? "it closed the connection"
                             : "it closed the connection without an answer; it may need mqtts://";
    case MOSQ_ERR_KEEPALIVE:
      return answer_ ? "it stopped answering" : kNoBroker;
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
