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

/// The content of a response.
struct WebContent {
  WebBytes bytes;
  std::string type;        ///< MIME type
  std::string file_name;   ///< not empty: the browser saves it under this name
  bool immutable = false;  ///< may be cached forever (its name contains a hash)
  /// Not empty: a file instead of `bytes`. It is read while it is sent, and parts of it may be requested
  /// (Range). The status is 404 if it cannot be read.
  std::filesystem::path file = {};
  unsigned status = 200;           ///< HTTP status, only with `bytes`
  std::string_view connects = {};  ///< more that this page may connect to, for its policy: "https:"
};

/// The content of a POST.
struct WebPost {
  std::string path;     ///< as for WebHandlers::get
  std::string type;     ///< its Content-Type, unchanged; may be empty
  std::string body;     ///< at most WebServerOptions::most_posted bytes, of any kind
  std::string host;     ///< its Host, which is one of this server's
  std::string address;  ///< numeric address of the client
};

struct WebServerOptions {
  std::string address = "127.0.0.1";  ///< where to listen; loopback by default
  std::uint16_t port = 7070;          ///< 0: any free one
  std::vector<std::string> hosts;  ///< more host names of the page (Host, Origin): "studio", or "studio:8080"
                                   ///< when a proxy has another port
  std::size_t most_clients = 32;   ///< open WebSockets; more are rejected with a message
  /// Connections besides the WebSockets: requests, and those that browsers keep open for the next request.
  /// Above three quarters of this number none is kept open.
  std::size_t more_connections = 96;
  std::size_t most_bytes_in = 64 * 1024;  ///< of one WebSocket message; a longer one closes the connection
  std::size_t most_posted = 4 * 1024;     ///< bytes of a POST; a longer one is refused (413)
  std::chrono::milliseconds request_within{
      10'000};  ///< for a complete request to arrive; also for idle connections
  std::chrono::milliseconds stalled_after{
      30'000};  ///< without progress in writing or any sign of life before a client is closed
  /// Not empty: TLS with this certificate and its key (web_stream.h). There are no WebSockets then.
  std::filesystem::path certificate = {};
  std::filesystem::path key = {};
};

/// Called from the server's thread. None may block. All may be empty. The message of an exception is sent to
/// the client (status 500, or a `message` of level error), and the server continues.
struct WebHandlers {
  /// The decoded, normalised absolute path ("/", "/assets/a.js"): nothing for 404. Never holds "..", NUL or
  /// a backslash.
  std::function<std::optional<WebContent>(const std::string& path)> get;
  /// A POST. The handler calls `answer` once, from any thread and at any time, even after the server is
  /// destroyed; a client that waits too long gets status 503. Empty: POST is not allowed (405).
  std::function<void(WebPost post, std::function<void(WebContent)> answer)> post;
  /// The content security policy for that Host; empty: that of the live page.
  std::function<std::string(std::string_view host)> policy;
  /// A client connected; the returned messages are sent to it first, in this order.
  std::function<std::vector<std::string>(std::uint64_t client)> opened;
  /// A text message, which may be any valid UTF-8; the reply, if any, is sent only to that client.
  std::function<std::optional<std::string>(std::uint64_t client, std::string_view text)> text;
};

/// Serves the page over HTTP (or HTTPS, see `certificate`) and a WebSocket at /ws, by default only to
/// browsers on this machine. It runs in its own thread. With address 127.0.0.1 it also listens on ::1, if the
/// system has it, because some browsers look for localhost there. Requests with a Host or Origin of another
/// server are rejected, so that no other web site can reach it. A client that does not read loses messages:
/// of each `topic` only the newest waits for it, and a client that has not read for 30 s is closed.
class WebServer {
 public:
  /// Throws Error(usage) if the address is invalid or TLS cannot be used, and Error(output) if the port is
  /// taken. The message says which and what to do.
  WebServer(WebServerOptions options, WebHandlers handlers);
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;
  ~WebServer();  ///< stop(), and closes all connections; returns within a second

  /// Disconnects all clients. After it returns, no handler is called and messages are discarded; other
  /// functions may still be called. Call it before destroying objects that handlers use. A second call does
  /// nothing. Must not be called from a handler or from several threads at once.
  void stop();

  std::uint16_t port() const;
  std::size_t clients() const;
  /// Whether any client gets messages of this topic; otherwise they need not be made.
  bool wanted(int topic) const;

  /// Sends to all clients. May be called from any thread and never blocks. `topic` is any small number: a
  /// message replaces a waiting one of the same topic. Messages of topic 0 (few, important ones) are never
  /// replaced and go before all others, which take turns; a client with 1000 waiting ones is closed.
  void send_text(int topic, std::shared_ptr<const std::string> text);
  void send_binary(int topic, std::shared_ptr<const std::string> bytes);

  /// Turns the messages of a topic on or off for a client (initially all are on) and drops one that waits.
  /// May be called from any thread, also from handlers; a client that has left is ignored. Topic 0 cannot be
  /// turned off.
  void set_topic(std::uint64_t client, int topic, bool on);
  /// Whether that client is connected over loopback: from this computer or through a proxy on it. False after
  /// it left. May be called from any thread, also from handlers.
  bool from_here(std::uint64_t client) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace telemime
