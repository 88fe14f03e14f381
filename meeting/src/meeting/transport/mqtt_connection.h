// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/steady_timer.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "meeting/transport/tls.h"
#include "telemime/streaming/send_queue.h"

struct mosquitto;
struct mosquitto_message;

namespace telemime::meeting {

/// Keeps libmosquitto initialised as long as one of these exists; unlike the library's own counter it is safe
/// among threads. From the first connection on, the library makes the process ignore SIGPIPE.
class MqttLibrary {
 public:
  MqttLibrary();
  MqttLibrary(const MqttLibrary&) = delete;
  MqttLibrary& operator=(const MqttLibrary&) = delete;
  ~MqttLibrary();
};

struct DestroyClient {
  void operator()(mosquitto* client) const;
};
using MqttClient = std::unique_ptr<mosquitto, DestroyClient>;

struct MqttServer {
  std::string host;
  std::uint16_t port = 0;
  std::optional<std::string> ca_file;  ///< TLS, as for MqttTls; nothing: no TLS
  std::string user;                    ///< empty: no account
  std::string password;
};

struct MqttMessage {
  std::string topic;
  std::string payload;
};

/// A random number for a participant's session, 1 to 65535.
std::uint16_t random_session();

/// A client id, "<who>-" and 8 random hexadecimal digits. Each connection has a new one, so that the broker
/// does not confuse it with an older connection that has not ended yet.
std::string random_client_id(const std::string& who);

/// An MQTT 3.1.1 connection in the thread of a SendLoop (libmosquitto without its own thread). All functions
/// but disconnect() and close() throw LinkBroken, and so do the handlers that run in SendLoop::wait().
class MqttConnection {
 public:
  /// Receives the messages of all subscriptions; called in SendLoop::wait().
  using OnMessage = std::function<void(const MqttMessage&)>;

  /// Throws Error(usage) like MqttTls.
  MqttConnection(SendLoop& loop, MqttServer server, OnMessage on_message);
  MqttConnection(const MqttConnection&) = delete;
  MqttConnection& operator=(const MqttConnection&) = delete;
  ~MqttConnection();

  /// Connects and logs in, within 5 s for each address of the host. The broker publishes `will`, retained,
  /// when the connection breaks.
  void open(const std::string& client_id, const std::optional<MqttMessage>& will);
  /// Waits at most 6 s for the broker's permission; when it refuses QoS 1, again for QoS 0.
  void subscribe(const std::string& filter);
  /// Publishes with QoS 0: the message is lost when the connection breaks.
  void publish(const std::string& topic, std::string_view payload);
  /// Publishes with QoS 1; the broker retains the newest message of the topic.
  void publish_retained(const MqttMessage& message) { publish_reliably(message, /*retain=*/true); }
  /// Publishes with QoS 1 to the current subscribers.
  void publish_reliably(const MqttMessage& message, bool retain = false);
  /// Whether nothing waits to be written.
  bool drained() const;
  /// Publishes the last messages, retained, and disconnects properly, so that the will is not published.
  /// Takes at most 0.5 s and does nothing when the connection is broken.
  void disconnect(std::span<const MqttMessage> last_messages) noexcept;
  void close() noexcept;

 private:
  static void on_connect(mosquitto* client, void* self, int code);
  static void on_subscribe(mosquitto* client, void* self, int id, int count, const int* granted);
  static void on_publish(mosquitto* client, void* self, int id);
  static void on_incoming(mosquitto* client, void* self, const mosquitto_message* message);

  void connect(const std::string& address, const std::string& client_id,
               const std::optional<MqttMessage>& will);
  void prepare(const std::string& client_id, const std::optional<MqttMessage>& will);
  [[noreturn]] void report_unreachable(const std::string& address, int result, int error);
  void watch_reads();
  void watch_writes();
  void watch_time();
  bool check_socket();
  void on_readable();
  bool is_open() const;
  bool wants_to_write() const;
  void check(int result) const;
  std::string reason(int result, int error) const;
  void wait_for_confirmation() noexcept;

  SendLoop& loop_;
  const MqttServer server_;
  const OnMessage on_message_;
  const MqttLibrary library_;
  std::unique_ptr<MqttTls> tls_;
  MqttClient client_;
  std::optional<boost::asio::posix::stream_descriptor> socket_;  ///< a duplicate of the library's socket
  boost::asio::steady_timer timer_;
  int generation_ = 0;  ///< of the socket; handlers of an older one do nothing
  bool write_watched_ = false;
  bool reached_ = false;               ///< the TCP connection is established
  bool refused_ = false;               ///< the TCP connection failed
  std::optional<int> answer_;          ///< of the broker to the connection
  std::optional<int> granted_;         ///< of the broker to the subscription
  std::set<int> unconfirmed_;          ///< ids of messages without a confirmation
  std::vector<MqttMessage> incoming_;  ///< received while the library was running
};

}  // namespace telemime::meeting
