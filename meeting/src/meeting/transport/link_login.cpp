// SPDX-License-Identifier: Apache-2.0
// The request for an account at the web server of a meeting.
#include <curl/curl.h>
#include <openssl/ssl.h>
#include <openssl/x509_vfy.h>

#include <algorithm>
#include <exception>
#include <memory>

#include "meeting/protocol/outcome.h"
#include "meeting/transport/login.h"
#include "meeting/transport/tls.h"
#include "telemime/core/errors.h"
#include "telemime/streaming/tcp.h"
#include "telemime/streaming/url.h"

namespace telemime::meeting {
namespace {

constexpr long kLongestRequest = 10;  // s
constexpr int kPoll = 50;             // ms between checks whether to cancel
constexpr std::size_t kLongestAnswer = 16 * 1024;
constexpr std::size_t kLongestField = 500;
constexpr std::string_view kExample = "http://localhost:7080/room#k=SECRET";

bool is_web_url(std::string_view text) {
  std::string scheme(text.substr(0, text.find("://")));
  std::transform(scheme.begin(), scheme.end(), scheme.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return scheme == "http" || scheme == "https";
}

[[noreturn]] void fail(const SendUrl& url, const std::string& reason) {
  throw Error(ErrorKind::input, "the meeting at " + url.text + " cannot be joined: " + reason);
}

std::string reason_of(long status) {
  switch (status) {
    case 403:
      return "this link is not valid; it may be old or truncated";
    case 404:
      return "there is no meeting; ask for a new link";
    case 409:
      return "it is full";
    case 423:
      return "it is locked";
    case 429:
      return "too many attempts; wait a minute";
    default:
      return "its server answers with " + std::to_string(status);
  }
}

CURL* new_easy() {
  static const CURLcode initialised = curl_global_init(CURL_GLOBAL_DEFAULT);
  return initialised == CURLE_OK ? curl_easy_init() : nullptr;
}

/// The host's addresses as CURLOPT_RESOLVE takes them; empty where the host is an IPv6 address itself.
/// Addresses of one network interface only (fe80::1%eth0) are left out: libcurl would refuse the whole list.
std::string resolved(const SendUrl& url, const std::vector<std::string>& addresses) {
  std::string list;
  for (const std::string& address : addresses) {
    if (address.find('%') == std::string::npos) {
      list += (list.empty() ? "" : ",") + address;
    }
  }
  const bool is_address = url.host.find(':') != std::string::npos;
  return is_address || list.empty() ? "" : url.host + ":" + std::to_string(*url.port) + ":" + list;
}

/// One POST request with a JSON body, by libcurl.
class Request {
 public:
  Request(const SendUrl& url, const LinkLogin& login, const std::string& body) : url_(url), login_(login) {
    if (!easy_ || !multi_) {
      fail(url, "no connection can be created");
    }
    const std::string target = url.scheme + "://" + host_and_port(url.host, *url.port) + "/room/enter";
    headers_.reset(curl_slist_append(nullptr, "Content-Type: application/json"));
    set(CURLOPT_URL, target.c_str());
    set(CURLOPT_HTTPHEADER, headers_.get());
    set(CURLOPT_COPYPOSTFIELDS, body.c_str());
    set(CURLOPT_PROXY, "");  // whatever the environment says
    set(CURLOPT_TIMEOUT, kLongestRequest);
    set(CURLOPT_NOSIGNAL, 1L);
    set(CURLOPT_WRITEFUNCTION, on_data);
    set(CURLOPT_WRITEDATA, this);
    if (const std::string entry = resolved(url, login.addresses); !entry.empty()) {
      addresses_.reset(curl_slist_append(nullptr, entry.c_str()));
      set(CURLOPT_RESOLVE, addresses_.get());
    }
    // Only the authorities that on_tls() adds are trusted.
    set(CURLOPT_SSLVERSION, static_cast<long>(CURL_SSLVERSION_TLSv1_2));
    set(CURLOPT_CAINFO, nullptr);
    set(CURLOPT_CAPATH, nullptr);
    set(CURLOPT_SSL_CTX_FUNCTION, on_tls);
    set(CURLOPT_SSL_CTX_DATA, this);
  }
  Request(const Request&) = delete;
  Request& operator=(const Request&) = delete;
  ~Request() { curl_multi_remove_handle(multi_.get(), easy_.get()); }

  /// The body of the answer 200.
  const std::string& answer() {
    const CURLcode result = perform();
    if (tls_failure_) {
      std::rethrow_exception(tls_failure_);
    }
    if (result != CURLE_OK) {
      fail(url_, reason_of_failure(result));
    }
    if (const long status = info(CURLINFO_RESPONSE_CODE); status != 200) {
      fail(url_, reason_of(status));
    }
    return answer_;
  }

 private:
  template <class Value>
  void set(CURLoption option, Value value) {
    curl_easy_setopt(easy_.get(), option, value);
  }

  long info(CURLINFO name) const {
    long value = 0;
    curl_easy_getinfo(easy_.get(), name, &value);
    return value;
  }

  static std::size_t on_data(char* data, std::size_t size, std::size_t count, void* self) {
    std::string& answer = static_cast<Request*>(self)->answer_;
    answer.append(data, size * count);
    return answer.size() <= kLongestAnswer ? size * count : 0;
  }

  static CURLcode on_tls(CURL* /*easy*/, void* context, void* self) {
    auto& own = *static_cast<Request*>(self);
    try {
      trust_authorities(static_cast<SSL_CTX*>(context), own.login_.ca);
      return CURLE_OK;
    } catch (...) {
      own.tls_failure_ = std::current_exception();
      return CURLE_ABORTED_BY_CALLBACK;
    }
  }

  CURLcode perform() {
    curl_multi_add_handle(multi_.get(), easy_.get());
    for (int running = 1; running > 0;) {
      curl_multi_perform(multi_.get(), &running);
      if (running > 0 && login_.stopped && login_.stopped()) {
        fail(url_, "it was cancelled");
      }
      if (running > 0) {
        curl_multi_poll(multi_.get(), nullptr, 0, kPoll, nullptr);
      }
    }
    int left = 0;
    const CURLMsg* const message = curl_multi_info_read(multi_.get(), &left);
    return message == nullptr ? CURLE_FAILED_INIT : message->data.result;
  }

  std::string reason_of_failure(CURLcode result) const {
    switch (result) {
      case CURLE_COULDNT_RESOLVE_HOST:
        return "no computer of that name was found";
      case CURLE_COULDNT_CONNECT:
        return in_words({static_cast<int>(info(CURLINFO_OS_ERRNO)), boost::system::system_category()});
      case CURLE_OPERATION_TIMEDOUT:
        return "it does not respond";
      case CURLE_GOT_NOTHING:
      case CURLE_SEND_ERROR:
      case CURLE_RECV_ERROR:
        return "it closed the connection";
      case CURLE_SSL_CONNECT_ERROR:
        return kNoTls;
      case CURLE_PEER_FAILED_VERIFICATION: {
        // If the certificate is trusted, but not for this host, curl leaves one of the first two.
        const long verified = info(CURLINFO_SSL_VERIFYRESULT);
        const bool trusted = verified == X509_V_OK || verified == X509_V_ERR_UNSPECIFIED;
        return tls_refusal(trusted ? X509_V_ERR_HOSTNAME_MISMATCH : verified, url_.host);
      }
      case CURLE_UNSUPPORTED_PROTOCOL:
      case CURLE_WEIRD_SERVER_REPLY:
        return "there is no meeting server";
      default:
        return curl_easy_strerror(result);
    }
  }

  using List = std::unique_ptr<curl_slist, void (*)(curl_slist*)>;
  const SendUrl& url_;
  const LinkLogin& login_;
  List headers_{nullptr, curl_slist_free_all};
  List addresses_{nullptr, curl_slist_free_all};
  std::unique_ptr<CURLM, CURLMcode (*)(CURLM*)> multi_{curl_multi_init(), curl_multi_cleanup};
  std::unique_ptr<CURL, void (*)(CURL*)> easy_{new_easy(), curl_easy_cleanup};
  std::string answer_;
  std::exception_ptr tls_failure_;
};

std::string field(const JsonField& json, const char* name) {
  return json.optional(name, [](const JsonField& f) { return f.text(kLongestField); }).value_or("");
}

bool is_topic(std::string_view topic) {
  return topic.starts_with("r/") && std::count(topic.begin(), topic.end(), '/') == 2 &&
         topic.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_-/") == std::string_view::npos;
}

Credentials credentials_in(const JsonField& json) {
  return {.broker = field(json, "tcp"),
          .user = field(json, "user"),
          .password = field(json, "password"),
          .topic = field(json, "topic"),
          .participant = field(json, "participant"),
          .rejoin = field(json, "return")};
}

Credentials credentials_of(const SendUrl& url, const std::string& body) {
  const auto credentials = read_if_valid(body, kMessageSource, credentials_in).value_or(Credentials{});
  if (credentials.user.empty() || credentials.password.empty() || !is_topic(credentials.topic)) {
    fail(url, "the answer of its server is invalid");
  }
  const bool secure = credentials.broker.starts_with("mqtts://");
  if (!secure && !credentials.broker.starts_with("mqtt://")) {
    fail(url, "its server does not name a broker for programs");
  }
  if (!secure && url.scheme == "https") {
    fail(url, "its broker is not encrypted, but its page is");
  }
  return credentials;
}

}  // namespace

bool is_meeting_link(std::string_view text) {
  return is_web_url(text) && text.find("#k=") != std::string_view::npos;
}

std::string without_secret(const std::string& link) {
  return is_web_url(link) ? without_password(link) : link;
}

Credentials log_in_by_link(const LinkLogin& login) {
  const auto invalid = [](const std::string& text) {
    return Error(ErrorKind::usage, "\"" + text + "\" is not the link of a meeting; it may be truncated",
                 "Write it like " + std::string(kExample) + ".");
  };
  if (!is_web_url(login.link)) {
    throw invalid(without_password(login.link));
  }
  SendUrl url = parse_url(login.link, kExample);
  if (url.path != "/room" || (url.password.empty() && login.rejoin.empty())) {
    throw invalid(url.text);
  }
  url.port = url.port.value_or(url.scheme == "https" ? 443 : 80);
  nlohmann::json question = {{"v", 1}, {"watch", login.watch}};
  if (!url.password.empty()) {
    question["invite"] = url.password;
  }
  if (!login.rejoin.empty()) {
    question["return"] = login.rejoin;
  }
  return credentials_of(
      url,
      Request(url, login, question.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)).answer());
}

}  // namespace telemime::meeting
