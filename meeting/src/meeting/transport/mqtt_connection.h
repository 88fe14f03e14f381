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

#include "meeting/transport/mqtt_library.h"
#include "meeting/transport/mqtt_tls.h"
#include "telemime/streaming/send_queue.h"

struct mosquitto;
struct mosquitto_message;

namespace telemime::meeting {

struct MqttServer {
  std::string host;
  std::uint16_t port = 0;
  std::optional<std::string> ca_file;  ///< TLS: as MqttTls asks; nothing: no TLS
  std::string user;                    ///< empty: nobody is asked who they are
  std::string password;
};

struct MqttMessage {
  std::string topic;
  std::string payload;
};

/// A connection to an MQTT broker, protocol 3.1.1, in the thread of a SendLoop: libmosquitto without a thread
/// of its own. All but goodbye() and close() throw LinkBroken; so do handlers that run in SendLoop::wait().
class MqttConnection {
 public:
  /// What was subscribed to and comes in; called in SendLoop::wait().
  using Heard = std::function<void(const MqttMessage&)>;

  /// Throws Error(usage) as MqttTls does.
  MqttConnection(SendLoop& loop, MqttServer server, Heard heard);
  MqttConnection(const MqttConnection&) = delete;
  MqttConnection& operator=(const MqttConnection&) = delete;
  ~MqttConnection();

  /// Connects and has the account accepted, within 5 s for each of the host's addresses. `will` is published,
  /// retained, when the connection breaks; who only listens has none.
  void open(const std::string& client_id, const std::optional<MqttMessage>& will);
  /// Waits for the broker's leave, 6 s at most; where QoS 1 is refused, once more for QoS 0.
  void subscribe(const std::string& filter);
  /// At most once; lost when the connection breaks.
  void tell(const std::string& topic, std::span<const std::uint8_t> payload);
  /// At least once as long as the connection stands, and the broker keeps the newest of the topic.
  void keep(const MqttMessage& message);
  /// At least once as long as the connection stands, to those who listen now.
  void say(const MqttMessage& message);
  /// Whether nothing waits to be written.
  bool drained() const;
  /// Last words, kept as above, and an orderly end: the will is not published. Takes half a second at most,
  /// and is left out when the connection has broken.
  void goodbye(std::span<const MqttMessage> last_words) noexcept;
  void close() noexcept;

 private:
  struct Destroy {
    void operator()(mosquitto* client) const;
  };
  static void on_connect(mosquitto* client, void* self, int code);
  static void on_subscribe(mosquitto* client, void* self, int id, int count, const int* granted);
  static void on_publish(mosquitto* client, void* self, int id);
  static void on_message(mosquitto* client, void* self, const mosquitto_message* message);

  void connect(const std::string& address, const std::string& client_id,
               const std::optional<MqttMessage>& will);
  void prepare(const std::string& client_id, const std::optional<MqttMessage>& will);
  void publish(const MqttMessage& message, bool retain);
  [[noreturn]] void tell_why_unreachable(const std::string& address, int result, int error);
  void watch_reads();
  void watch_writes();
  void watch_time();
  bool look_at_socket();
  void on_readable();
  void hand_out();
  bool is_open() const;
  bool wants_to_write() const;
  void check(int result) const;
  std::string words_for(int result, int error) const;
  void wait_for_confirmation() noexcept;

  SendLoop& loop_;
  const MqttServer server_;
  const Heard heard_;
  const MqttLibrary library_;
  std::unique_ptr<MqttTls> tls_;
  std::unique_ptr<mosquitto, Destroy> client_;
  std::optional<boost::asio::posix::stream_descriptor> socket_;  ///< a second name of the library's socket
  boost::asio::steady_timer timer_;
  int generation_ = 0;  ///< of the socket: handlers of an older one do nothing
  bool write_watched_ = false;
  bool reached_ = false;               ///< the TCP connection stands
  bool refused_ = false;               ///< it does not come about
  std::optional<int> answer_;          ///< of the broker to the connection
  std::optional<int> granted_;         ///< of the broker to the subscription
  std::set<int> unconfirmed_;          ///< kept messages, by the library's numbers
  std::vector<MqttMessage> incoming_;  ///< heard while the library was at work
};

}  // namespace telemime::meeting
