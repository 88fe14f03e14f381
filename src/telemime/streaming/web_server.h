// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace telemime {

using WebBytes = std::shared_ptr<const std::string>;

/// What a request is answered with.
struct WebContent {
  WebBytes bytes;
  std::string type;        ///< MIME type
  std::string file_name;   ///< not empty: to be saved under this name
  bool immutable = false;  ///< may be cached for ever (its name has a hash in it)
  /// Not empty: a file instead of `bytes`. It is read bit by bit as it is sent, and parts of it may be asked
  /// for (Range). A file that cannot be read is answered 404.
  std::filesystem::path file = {};
  unsigned status = 200;  ///< of HTTP, for `bytes` alone
};

/// What a POST brings.
struct WebPost {
  std::string path;     ///< as WebHandlers::get has it
  std::string type;     ///< its Content-Type as it stands there; may be empty
  std::string body;     ///< at most WebServerOptions::most_posted bytes, any
  std::string host;     ///< its Host, which is one of this server's
  std::string address;  ///< from where it came, in numbers
};

struct WebServerOptions {
  std::string address = "127.0.0.1";  ///< where to listen: loopback unless asked
  std::uint16_t port = 7070;          ///< 0: any free one
  std::vector<std::string> hosts;     ///< further names under which the page may be called (Host, Origin):
                                      ///< "studio", or "studio:8080" when a proxy has another port
  std::size_t most_clients = 32;      ///< open WebSockets; more are refused with a message
  /// Connections in all, beside the clients: requests, and those that browsers keep open for the next one.
  /// From three quarters of them on none is kept open.
  std::size_t more_connections = 96;
  std::size_t most_bytes_in = 64 * 1024;  ///< of one WebSocket message; a longer one closes the connection
  std::size_t most_posted = 4 * 1024;     ///< bytes of a POST; a longer one is refused (413)
  std::chrono::milliseconds request_within{10'000};  ///< for a whole request to come; idle connections, too
  std::chrono::milliseconds stalled_after{
      30'000};  ///< without progress in writing, or a sign of life: closed
  /// Not empty: TLS with this certificate and its key (web_stream.h). There are no WebSockets then.
  std::filesystem::path certificate = {};
  std::filesystem::path key = {};
};

/// Called from the server's thread. None may block. All may be empty. What one throws goes to its client in
/// words (500, or a `message` of level error), and the server goes on.
struct WebHandlers {
  /// The decoded, normalised absolute path ("/", "/assets/a.js"): nothing for 404. Never holds "..", NUL or
  /// a backslash.
  std::function<std::optional<WebContent>(const std::string& path)> get;
  /// A POST. `answer` is called once, from any thread and at any time, also when the server is gone; a client
  /// that waits too long gets status 503. Empty: POST is not allowed (405).
  std::function<void(WebPost post, std::function<void(WebContent)> answer)> post;
  /// The content security policy of what was asked for under that Host; empty: that of the live page.
  std::function<std::string(std::string_view host)> policy;
  /// A client has come; what is returned is sent to it first, in this order.
  std::function<std::vector<std::string>(std::uint64_t client)> opened;
  /// A text message, any bytes that are valid UTF-8; the answer, if there is one, goes to that client alone.
  std::function<std::optional<std::string>(std::uint64_t client, std::string_view text)> text;
  std::function<void(std::uint64_t client)> closed;
};

/// Serves the page over HTTP (or HTTPS, see `certificate`) and a WebSocket at /ws, to browsers on this
/// machine unless asked otherwise. In a thread of its own. For address 127.0.0.1 it listens on ::1, too,
/// where there is one: some browsers ask for localhost there. Requests with a Host or an Origin that is not
/// this server's are refused, so that no other web site can reach it. A client that does not read loses
/// messages, never memory: of each `topic` only the newest waits for it; one that has not read for 30 s is
/// closed.
class WebServer {
 public:
  /// Throws Error(usage) when the address is no address or TLS cannot be used, Error(output) when the port is
  /// taken (the words say which and what to do).
  WebServer(WebServerOptions options, WebHandlers handlers);
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;
  ~WebServer();  ///< stop(), and closes all connections; returns within a second

  /// All clients leave, and then nothing is answered: when it returns no handler is called any more, and what
  /// is sent is forgotten. The rest may still be called. Whoever has handlers that use the server itself
  /// calls this before they let go of it. The second time it does nothing. Not for handlers, and not from
  /// several threads at once.
  void stop();

  std::uint16_t port() const;
  std::size_t clients() const;
  /// Whether there is a client that gets messages of this topic: what nobody gets need not be made.
  bool wanted(int topic) const;

  /// To all clients; from any thread, never blocks. `topic` is any small number: a message of a topic
  /// replaces one of the same topic that still waits. Topic 0 is never replaced (few, important ones; a
  /// client that lets 1000 of them wait is closed) and overtakes the others, which take turns.
  void send_text(int topic, std::shared_ptr<const std::string> text);
  void send_binary(int topic, std::shared_ptr<const std::string> bytes);

  /// Whether that client gets messages of that topic (at first of every one); one that waits is dropped. From
  /// any thread, handlers included; a client that is gone is no error. Topic 0 cannot be turned off.
  void set_topic(std::uint64_t client, int topic, bool on);
  /// Whether that client's connection came over loopback: from this computer, a proxy on it included. False
  /// when it is gone. From any thread, handlers included.
  bool from_here(std::uint64_t client) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace telemime
