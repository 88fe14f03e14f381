// SPDX-License-Identifier: Apache-2.0
#include "meeting/transport/mqtt_connection.h"

#include <mosquitto.h>
#include <openssl/ssl.h>
#include <poll.h>

#include <boost/asio/io_context.hpp>
#include <cerrno>
#include <chrono>
#include <mutex>
#include <random>
#include <utility>

#include "meeting/protocol/topics.h"

namespace telemime::meeting {

namespace asio = boost::asio;
using std::chrono::milliseconds;
using SteadyClock = std::chrono::steady_clock;

namespace {

constexpr milliseconds kLongestGrant{6000};  // a cluster that lost a node takes 4 s to refuse
constexpr milliseconds kTick{1000};          // as libmosquitto recommends
constexpr milliseconds kLongestGoodbye{500};
constexpr std::size_t kLongestTopic = 256;
constexpr int kSubscriptionRefused = 0x80;  // MQTT 3.1.1, 3.9.3
constexpr int kAtMostOnce = 0;
constexpr int kAtLeastOnce = 1;

// The counter of the library has no lock and is one for the whole process.
std::mutex& count_mutex() {
  static std::mutex mutex;
  return mutex;
}

}  // namespace

MqttLibrary::MqttLibrary() {
  const std::lock_guard lock(count_mutex());
  mosquitto_lib_init();
}

MqttLibrary::~MqttLibrary() {
  const std::lock_guard lock(count_mutex());
  mosquitto_lib_cleanup();
}

void DestroyClient::operator()(mosquitto* client) const {
  mosquitto_destroy(client);
}

std::uint16_t random_session() {
  std::random_device random;
  return static_cast<std::uint16_t>(std::uniform_int_distribution<int>(1, UINT16_MAX)(random));
}

std::string random_client_id(const std::string& who) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::random_device random;
  std::string id = who + "-";
  for (int i = 0; i < 8; ++i) {
    id += kDigits[random() % kDigits.size()];
  }
  return id;
}

MqttConnection::MqttConnection(SendLoop& loop, MqttServer server, OnMessage on_message)
    : loop_(loop), server_(std::move(server)), on_message_(std::move(on_message)), timer_(loop.io()) {
  if (server_.ca_file) {
    tls_ = std::make_unique<MqttTls>(server_.host, *server_.ca_file);
  }
}

MqttConnection::~MqttConnection() {
  close();
}

// Called by libmosquitto, a C library: they must not throw.
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

void MqttConnection::on_incoming(mosquitto* /*client*/, void* self, const mosquitto_message* message) {
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
                          if (check_socket()) {
                            check(mosquitto_loop_write(client_.get(), 1));
                            watch_writes();
                          }
                        }
                      });
}

// Drives the keep-alive of the library.
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
  if (!check_socket()) {
    return;
  }
  check(mosquitto_loop_read(client_.get(), 1));
  if (mosquitto_want_write(client_.get())) {
    check(mosquitto_loop_write(client_.get(), 1));  // what TLS could not write before it had read
  }
  watch_writes();
  for (const MqttMessage& message : std::exchange(incoming_, {})) {
    on_message_(message);
  }
}

bool MqttConnection::is_open() const {
  return client_ && answer_ == 0 && mosquitto_socket(client_.get()) >= 0;
}

bool MqttConnection::wants_to_write() const {
  // During a TLS handshake there may be nothing to write before something was read.
  const auto* const connection = static_cast<const SSL*>(mosquitto_ssl_get(client_.get()));
  return mosquitto_want_write(client_.get()) && (connection == nullptr || !SSL_want_read(connection));
}

void MqttConnection::check(int result) const {
  if (result != MOSQ_ERR_SUCCESS) {
    throw LinkBroken(reason(result, errno));
  }
}

void MqttConnection::subscribe(const std::string& filter) {
  // A broker cluster that has just lost a node may not be able to grant more than QoS 0.
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
  throw LinkBroken("this account may not read the meeting");
}

void MqttConnection::publish(const std::string& topic, std::string_view payload) {
  check(mosquitto_publish(client_.get(), nullptr, topic.c_str(), static_cast<int>(payload.size()),
                          payload.data(), kAtMostOnce, /*retain=*/false));
  watch_writes();
}

void MqttConnection::publish_reliably(const MqttMessage& message, bool retain) {
  int id = 0;
  check(mosquitto_publish(client_.get(), &id, message.topic.c_str(), static_cast<int>(message.payload.size()),
                          message.payload.data(), kAtLeastOnce, retain));
  unconfirmed_.insert(id);
  watch_writes();
}

bool MqttConnection::drained() const {
  return client_ && !mosquitto_want_write(client_.get());
}

void MqttConnection::disconnect(std::span<const MqttMessage> last_messages) noexcept {
  if (!is_open()) {
    return;
  }
  try {
    for (const MqttMessage& message : last_messages) {
      publish_retained(message);
    }
  } catch (const std::exception&) {
    return;  // the broker publishes the will instead
  }
  wait_for_confirmation();
  mosquitto_disconnect(client_.get());
}

// Without the loop, which is ending. Closing at once could lose what was written.
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
