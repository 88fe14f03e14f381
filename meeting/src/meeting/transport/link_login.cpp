// SPDX-License-Identifier: Apache-2.0
#include "meeting/transport/link_login.h"

#include <openssl/ssl.h>
#include <openssl/x509v3.h>

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ssl/stream.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/http/write.hpp>
#include <cctype>
#include <nlohmann/json.hpp>
#include <optional>

#include "meeting/transport/mqtt_tls.h"
#include "meeting/transport/tls_authorities.h"
#include "telemime/core/errors.h"
#include "telemime/streaming/resolve.h"
#include "telemime/streaming/tcp.h"
#include "telemime/streaming/url.h"

namespace telemime::meeting {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using boost::system::error_code;
using Json = nlohmann::json;

constexpr std::chrono::seconds kLongestVisit{10};
constexpr std::chrono::milliseconds kLook{50};  // whether to give up
constexpr std::size_t kLongestAnswer = 16 * 1024;
constexpr std::size_t kLongestField = 500;
constexpr int kDeepestAnswer = 4;
constexpr std::string_view kExample = "http://localhost:7080/room#k=INVITE";
constexpr std::string_view kPath = "/room";

std::string small(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return result;
}

bool is_page(std::string_view text) {
  const std::string scheme = small(text.substr(0, text.find("://")));
  return scheme == "http" || scheme == "https";
}

[[noreturn]] void unreachable(const SendUrl& url, const std::string& why) {
  throw Error(ErrorKind::input, "the room at " + url.text + " cannot be entered: " + why);
}

using Secure = asio::ssl::stream<beast::tcp_stream&>;

/// TLS 1.2 or newer to servers that the authorities of `ca` (empty: the system's) vouch for.
asio::ssl::context client_tls(const std::filesystem::path& ca) {
  asio::ssl::context tls(asio::ssl::context::tls_client);
  SSL_CTX* const native = tls.native_handle();
  SSL_CTX_set_min_proto_version(native, TLS1_2_VERSION);
  trust_authorities(native, ca);
  SSL_CTX_set_verify(native, SSL_VERIFY_PEER, nullptr);
  return tls;
}

/// The host must stand in the certificate, and is told which of its certificates is meant.
void expect(Secure& secure, const std::string& host) {
  SSL* const native = secure.native_handle();
  X509_VERIFY_PARAM* const asked = SSL_get0_param(native);
  X509_VERIFY_PARAM_set_hostflags(asked, X509_CHECK_FLAG_NO_PARTIAL_WILDCARDS);
  error_code no_address;
  asio::ip::make_address(host, no_address);
  if (no_address) {
    SSL_set_tlsext_host_name(native, host.c_str());
    X509_VERIFY_PARAM_set1_host(asked, host.c_str(), host.size());
  } else {
    X509_VERIFY_PARAM_set1_ip_asc(asked, host.c_str());
  }
}

/// One request to the room's server and its answer, with one limit of time for all of it.
class Visit {
 public:
  Visit(const SendUrl& url, const LinkLogin& entry)
      : url_(url), entry_(entry), tcp_(io_), until_(std::chrono::steady_clock::now() + kLongestVisit) {
    if (url.scheme == "https") {
      tls_.emplace(client_tls(entry.ca));
    }
  }

  http::response<http::string_body> ask(const http::request<http::string_body>& request) {
    connect();
    if (!tls_) {
      return ask(tcp_, request);
    }
    Secure secure(tcp_, *tls_);
    expect(secure, url_.host);
    const error_code error = run([&](auto note) { secure.async_handshake(secure.client, note); });
    if (error) {
      const long result = SSL_get_verify_result(secure.native_handle());
      unreachable(url_, result == X509_V_OK ? "no TLS connection comes about; is TLS spoken at that port?"
                                            : tls_refusal(result, url_.host));
    }
    return ask(secure, request);
  }

 private:
  /// Begins an operation and waits for its end.
  template <class Begin>
  error_code run(const Begin& begin) {
    std::optional<error_code> ended;
    tcp_.expires_at(until_);
    begin([&ended](error_code error, auto&&...) { ended = error; });
    io_.restart();
    bool given_up = false;
    while (!ended && !io_.stopped()) {
      io_.run_one_for(kLook);
      if (!given_up && entry_.stopped && entry_.stopped()) {
        given_up = true;
        tcp_.cancel();
      }
    }
    if (given_up) {
      unreachable(url_, "it was given up");
    }
    if (!ended || *ended == beast::error::timeout) {
      unreachable(url_, "no answer from there");
    }
    return *ended;
  }

  std::vector<std::string> addresses() const {
    if (!entry_.addresses.empty()) {
      return entry_.addresses;
    }
    error_code no_address;
    asio::ip::make_address(url_.host, no_address);
    try {
      return no_address ? system_lookup(url_.host) : std::vector<std::string>{url_.host};
    } catch (const LinkBroken& e) {
      unreachable(url_, e.what());
    }
  }

  void connect() {
    std::optional<error_code> first;
    for (const std::string& address : addresses()) {
      const asio::ip::tcp::endpoint there(asio::ip::make_address(address), *url_.port);
      const error_code error = run([&](auto note) { tcp_.async_connect(there, note); });
      if (!error) {
        return;
      }
      first = first.value_or(error);
      tcp_.close();  // an IPv4 socket reaches no IPv6 address
    }
    unreachable(url_, first ? in_words(*first) : "no computer of that name is known");
  }

  template <class Stream>
  http::response<http::string_body> ask(Stream& stream, const http::request<http::string_body>& request) {
    error_code error = run([&](auto note) { http::async_write(stream, request, note); });
    beast::flat_buffer buffer(kLongestAnswer);
    http::response_parser<http::string_body> answer;
    answer.body_limit(kLongestAnswer);
    if (!error) {
      error = run([&](auto note) { http::async_read(stream, buffer, answer, note); });
    }
    if (error) {
      const bool another = error.category() == http::make_error_code(http::error::bad_method).category();
      unreachable(url_, another ? "no room's server answers there" : in_words(error));
    }
    return answer.release();
  }

  const SendUrl& url_;
  const LinkLogin& entry_;
  asio::io_context io_{1};
  beast::tcp_stream tcp_;
  std::chrono::steady_clock::time_point until_;
  std::optional<asio::ssl::context> tls_;
};

std::string words_for(unsigned status) {
  switch (status) {
    case 403:
      return "this link does not open it; it may be old, or cut off";
    case 404:
      return "there is no room; ask for a new link";
    case 409:
      return "all of its seats are taken";
    case 423:
      return "it is locked, nobody new comes in now";
    case 429:
      return "too many tries; wait a minute";
    default:
      return "its server answers with " + std::to_string(status);
  }
}

std::string text_of(const Json& json, const char* name) {
  if (!json.contains(name) || !json[name].is_string()) {
    return {};
  }
  auto text = json[name].get<std::string>();
  return text.size() <= kLongestField ? text : std::string();
}

bool is_topic(std::string_view topic) {
  const auto may_stand = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-' || c == '/';
  };
  return topic.starts_with("r/") && std::all_of(topic.begin(), topic.end(), may_stand) &&
         std::count(topic.begin(), topic.end(), '/') == 2;
}

Credentials key_of(const SendUrl& url, const std::string& body) {
  const Json json = Json::parse(
      body, [](int depth, Json::parse_event_t, Json&) { return depth < kDeepestAnswer; },
      /*allow_exceptions=*/false);
  if (!json.is_object()) {
    unreachable(url, "its server gave an answer that cannot be understood");
  }
  Credentials key{text_of(json, "tcp"),   text_of(json, "user"),        text_of(json, "password"),
                  text_of(json, "topic"), text_of(json, "participant"), {},
                  text_of(json, "return")};
  if (json.contains("roles") && json["roles"].is_array()) {
    for (const Json& role : json["roles"]) {
      if (role.is_string()) {
        key.roles.push_back(role.get<std::string>());
      }
    }
  }
  if (key.user.empty() || key.password.empty() || !is_topic(key.topic)) {
    unreachable(url, "its server gave an answer that cannot be understood");
  }
  const bool secure = key.broker.starts_with("mqtts://");
  if (!secure && !key.broker.starts_with("mqtt://")) {
    unreachable(url, "its server does not say where programs reach the broker");
  }
  if (!secure && url.scheme == "https") {
    unreachable(url, "its broker is not encrypted, unlike its page");
  }
  return key;
}

}  // namespace

bool is_meeting_link(std::string_view text) {
  return is_page(text) && text.find("#k=") != std::string_view::npos;
}

std::string without_secret(const std::string& link) {
  return is_page(link) ? without_password(link) : link;
}

Credentials log_in_by_link(const LinkLogin& entry) {
  if (!is_page(entry.link)) {
    throw Error(ErrorKind::usage, "\"" + without_password(entry.link) + "\" is no link to a room",
                "Write it like " + std::string(kExample) + ".");
  }
  SendUrl url = parse_url(entry.link, kExample);
  require_host(url);
  if (url.path != kPath || (url.password.empty() && entry.rejoin.empty())) {
    throw Error(ErrorKind::usage, "\"" + url.text + "\" is no link to a room; it may be cut off",
                "Write it like " + std::string(kExample) + ".");
  }
  const bool usual = !url.port;
  url.port = url.port.value_or(url.scheme == "https" ? 443 : 80);
  Json question = {{"v", 1}, {"watch", entry.watch}};
  if (!url.password.empty()) {
    question["invite"] = url.password;
  }
  if (!entry.rejoin.empty()) {
    question["return"] = entry.rejoin;
  }
  http::request<http::string_body> request(http::verb::post, "/room/enter", 11);
  const std::string host = host_and_port(url.host, *url.port);
  request.set(http::field::host, usual ? host.substr(0, host.rfind(':')) : host);
  request.set(http::field::content_type, "application/json");
  request.set(http::field::connection, "close");
  request.body() = question.dump(-1, ' ', false, Json::error_handler_t::replace);
  request.prepare_payload();
  const http::response<http::string_body> answer = Visit(url, entry).ask(request);
  if (answer.result_int() != 200) {
    unreachable(url, words_for(answer.result_int()));
  }
  return key_of(url, answer.body());
}

}  // namespace telemime::meeting
