// SPDX-License-Identifier: Apache-2.0
#include "meeting/transport/mqtt_connection.h"

#include <mosquitto.h>
#include <openssl/ssl.h>
#include <poll.h>

#include <boost/asio/io_context.hpp>
#include <cerrno>
#include <chrono>
#include <utility>

namespace telemime::meeting {

namespace asio = boost::asio;
using std::chrono::milliseconds;
using SteadyClock = std::chrono::steady_clock;

namespace {

constexpr milliseconds kLongestGrant{6000};  // a cluster in need takes 4 s to refuse
constexpr milliseconds kTick{1000};          // libmosquitto's own wish
constexpr milliseconds kLongestGoodbye{500};
constexpr std::size_t kLongestTopic = 256;
constexpr std::size_t kLongestPayload = 16384;
constexpr int kSubscriptionRefused = 0x80;  // MQTT 3.1.1, 3.9.3
constexpr int kAtMostOnce = 0;
constexpr int kAtLeastOnce = 1;

}  // namespace

void MqttConnection::Destroy::operator()(mosquitto* client) const {
  mosquitto_destroy(client);
}

MqttConnection::MqttConnection(SendLoop& loop, MqttServer server, Heard heard)
    : loop_(loop), server_(std::move(server)), heard_(std::move(heard)), timer_(loop.io()) {
  if (server_.ca_file) {
    tls_ = std::make_unique<MqttTls>(server_.host, *server_.ca_file);
  }
}

MqttConnection::~MqttConnection() {
  close();
}

// Called by libmosquitto, which knows no exceptions: they only take notes.
void MqttConnection::on_connect(mosquitto* /*client*/, void* self, int code) {
  static_cast<MqttConnection*>(self)->answer_ = code;
}

void MqttConnection::on_subscribe(mosquitto* /*client*/, void* self, int /*id*/, int count,
                                  const int* granted) {
  static_cast<MqttConnection*>(self)->granted_ = count > 0 ? *granted : kSubscriptionRefused;
}

void MqttConnection::on_publish(mosquitto* /*client*/, void* self, int id) {
  static_cast<MqttConnection*>(self)->unconfirmed_.erase(id);
}

void MqttConnection::on_message(mosquitto* /*client*/, void* self, const mosquitto_message* message) {
  const std::string_view topic(message->topic);
  const auto size = static_cast<std::size_t>(message->payloadlen);
  if (topic.size() <= kLongestTopic && size <= kLongestPayload) {
    static_cast<MqttConnection*>(self)->incoming_.push_back(
        {std::string(topic), size == 0 ? "" : std::string(static_cast<const char*>(message->payload), size)});
  }
}

void MqttConnection::watch_reads() {
  socket_->async_wait(asio::posix::stream_descriptor::wait_read,
                      [this, generation = generation_](const boost::system::error_code& error) {
                        if (!error && generation == generation_) {
                          on_readable();
                          if (!refused_) {
                            watch_reads();
                          }
                        }
                      });
}

void MqttConnection::watch_writes() {
  if (write_watched_ || !wants_to_write()) {
    return;
  }
  write_watched_ = true;
  socket_->async_wait(asio::posix::stream_descriptor::wait_write,
                      [this, generation = generation_](const boost::system::error_code& error) {
                        if (!error && generation == generation_) {
                          write_watched_ = false;
                          if (look_at_socket()) {
                            check(mosquitto_loop_write(client_.get(), 1));
                            watch_writes();
                          }
                        }
                      });
}

// For the library's keep-alive.
void MqttConnection::watch_time() {
  timer_.expires_after(kTick);
  timer_.async_wait([this, generation = generation_](const boost::system::error_code& error) {
    if (!error && generation == generation_) {
      check(mosquitto_loop_misc(client_.get()));
      watch_writes();
      watch_time();
    }
  });
}

void MqttConnection::on_readable() {
  if (!look_at_socket()) {
    return;
  }
  check(mosquitto_loop_read(client_.get(), 1));
  if (mosquitto_want_write(client_.get())) {
    check(mosquitto_loop_write(client_.get(), 1));  // what TLS held back until it had read
  }
  watch_writes();
  hand_out();
}

void MqttConnection::hand_out() {
  for (const MqttMessage& message : std::exchange(incoming_, {})) {
    heard_(message);
  }
}

bool MqttConnection::is_open() const {
  return client_ && answer_ == 0 && mosquitto_socket(client_.get()) >= 0;
}

bool MqttConnection::wants_to_write() const {
  // In the middle of a TLS handshake there may be nothing to write before something was read.
  const auto* const connection = static_cast<const SSL*>(mosquitto_ssl_get(client_.get()));
  return mosquitto_want_write(client_.get()) && (connection == nullptr || !SSL_want_read(connection));
}

void MqttConnection::check(int result) const {
  if (result != MOSQ_ERR_SUCCESS) {
    throw LinkBroken(words_for(result, errno));
  }
}

void MqttConnection::subscribe(const std::string& filter) {
  // A broker cluster that has just lost a node may be unable to grant more than QoS 0.
  for (const int quality : {kAtLeastOnce, kAtMostOnce}) {
    granted_.reset();
    check(mosquitto_subscribe(client_.get(), nullptr, filter.c_str(), quality));
    watch_writes();
    if (!loop_.wait([this] { return granted_.has_value(); }, kLongestGrant)) {
      throw LinkBroken("it does not answer");
    }
    if (*granted_ != kSubscriptionRefused) {
      return;
    }
  }
  throw LinkBroken("this user may not read there");
}

void MqttConnection::tell(const std::string& topic, std::span<const std::uint8_t> payload) {
  check(mosquitto_publish(client_.get(), nullptr, topic.c_str(), static_cast<int>(payload.size()),
                          payload.data(), kAtMostOnce, /*retain=*/false));
  watch_writes();
}

void MqttConnection::keep(const MqttMessage& message) {
  publish(message, /*retain=*/true);
}

void MqttConnection::say(const MqttMessage& message) {
  publish(message, /*retain=*/false);
}

void MqttConnection::publish(const MqttMessage& message, bool retain) {
  int id = 0;
  check(mosquitto_publish(client_.get(), &id, message.topic.c_str(), static_cast<int>(message.payload.size()),
                          message.payload.data(), kAtLeastOnce, retain));
  unconfirmed_.insert(id);
  watch_writes();
}

bool MqttConnection::drained() const {
  return client_ && !mosquitto_want_write(client_.get());
}

void MqttConnection::goodbye(std::span<const MqttMessage> last_words) noexcept {
  if (!is_open()) {
    return;
  }
  try {
    for (const MqttMessage& message : last_words) {
      keep(message);
    }
  } catch (const std::exception&) {
    return;  // then the will says it
  }
  wait_for_confirmation();
  mosquitto_disconnect(client_.get());
}

// Not by the loop, which is ending. Closed at once, what was written might not arrive.
void MqttConnection::wait_for_confirmation() noexcept {
  const auto end = SteadyClock::now() + kLongestGoodbye;
  while (!unconfirmed_.empty() && is_open()) {
    const auto left = std::chrono::duration_cast<milliseconds>(end - SteadyClock::now());
    const int events = wants_to_write() ? POLLIN | POLLOUT : POLLIN;
    pollfd entry{mosquitto_socket(client_.get()), static_cast<short>(events), 0};
    if (left.count() <= 0 || ::poll(&entry, 1, static_cast<int>(left.count())) <= 0) {
      return;
    }
    if (mosquitto_loop_read(client_.get(), 1) != MOSQ_ERR_SUCCESS ||
        mosquitto_loop_write(client_.get(), 1) != MOSQ_ERR_SUCCESS) {
      return;
    }
  }
}

void MqttConnection::close() noexcept {
  ++generation_;
  boost::system::error_code ignored;
  timer_.cancel(ignored);
  if (socket_) {
    socket_->close(ignored);
    socket_.reset();
  }
  client_.reset();
  write_watched_ = false;
  reached_ = false;
  refused_ = false;
  answer_.reset();
  granted_.reset();
  unconfirmed_.clear();
  incoming_.clear();
}

}  // namespace telemime::meeting
