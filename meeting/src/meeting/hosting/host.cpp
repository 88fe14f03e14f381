// SPDX-License-Identifier: Apache-2.0
#include "meeting/hosting/host.h"

#include <string_view>
#include <utility>

#include "meeting/hosting/ports.h"
#include "meeting/hosting/provisioning.h"
#include "meeting/hosting/secrets.h"
#include "meeting/hosting/service.h"
#include "telemime/core/errors.h"
#include "telemime/streaming/web_stream.h"

namespace telemime::meeting {
namespace {

constexpr std::size_t kMostParticipants = 500;
constexpr std::size_t kLongestTitle = 200;  // bytes
constexpr unsigned kNotFound = 404;
constexpr unsigned kWrongType = 415;
constexpr unsigned kUnavailable = 503;

WebContent plain_text(unsigned status, const std::string& text) {
  WebContent content;
  content.bytes = std::make_shared<const std::string>(text + "\n");
  content.type = "text/plain; charset=utf-8";
  content.status = status;
  return content;
}

/// "name:7080" without its port. The broker listens at IPv4 addresses only, so "[::1]" becomes localhost.
std::string name_of(std::string_view host) {
  return host.starts_with('[') ? "localhost" : std::string(host.substr(0, host.find(':')));
}

std::string text_of(LoginResult result) {
  switch (result) {
    case LoginResult::wrong_link:
      return "This link is not valid.";
    case LoginResult::full:
      return "The meeting is full.";
    case LoginResult::locked:
      return "The meeting is locked.";
    case LoginResult::too_many_attempts:
      return "Too many attempts. Wait a minute.";
    default:
      return "The request is not valid.";
  }
}

HostOptions checked(HostOptions options) {
  check_name(options.name);
  check_name(options.tenant);
  if (options.seats < 1 || options.seats > 100 || options.most < 1 || options.most > kMostParticipants) {
    throw Error(ErrorKind::usage, "a meeting has 1 to 100 seats and at most " +
                                      std::to_string(kMostParticipants) + " participants");
  }
  if (options.title.size() > kLongestTitle) {
    throw Error(ErrorKind::usage, "the title is longer than " + std::to_string(kLongestTitle) + " bytes");
  }
  if (options.certificate.empty() != options.key.empty()) {
    throw Error(ErrorKind::usage, "TLS needs a certificate and its key",
                "Give both: --certificate FILE --key FILE.");
  }
  if (options.address == "localhost") {
    options.address = "127.0.0.1";
  }
  options.broker.address = options.address;
  options.broker.certificate = options.certificate;
  options.broker.key = options.key;
  // A participant has a page, a tracker, and sometimes an old connection besides a new one.
  options.broker.most_connections = static_cast<int>(4 * options.most) + 200;
  options.broker.page_port = options.port;
  return options;
}

MeetingSecrets secrets_of(SecretsFile& file, bool new_links) {
  if (!new_links) {
    return file.load();
  }
  MeetingSecrets secrets = new_secrets();
  file.save(secrets);
  return secrets;
}

std::string link_host(const HostOptions& options) {
  if (!options.host.empty()) {
    return options.host;
  }
  if (options.address == "0.0.0.0") {
    return own_address();
  }
  return options.address == "127.0.0.1" ? "localhost" : options.address;
}

}  // namespace

struct MeetingHost::State {
  State(HostOptions given, Report reporter)
      : options(checked(std::move(given))),
        report(std::move(reporter)),
        meeting{options.tenant, options.name},
        file(options.secrets),
        secrets(secrets_of(file, options.new_links)),
        service_key(service_account(meeting)),
        provisioning(
            meeting,
            LoginPolicy(secrets, {.most = options.most, .keeps_seat = options.keeps_seat, .rate_limit = {}}),
            service_key, file, provisioning_hooks()) {
    if (!options.certificate.empty()) {
      web_tls(options.certificate, options.key);  // reports wrong files before anything starts
    }
    broker.emplace(options.broker, meeting, provisioning.accounts(), report);
    MeetingInfo info;
    info.title = options.title;
    info.seats = options.seats;
    service.emplace(broker->socket(), meeting, service_key, info, service_hooks());
    provisioning.open(*broker);
    server.emplace(web_options(), web_handlers());
  }
  ~State() {
    if (server) {
      server->stop();
    }
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  Provisioning::Hooks provisioning_hooks() {
    return {[this](std::vector<std::string> chairs, const std::vector<std::string>& freed) {
              service->set_chairs(std::move(chairs));
              service->forget(freed);
            },
            report};
  }

  MeetingService::Hooks service_hooks() {
    return {[this](const std::string& id, bool here) { provisioning.set_presence(id, here); },
            [this](const MeetingInfo& info) { provisioning.lock(info.locked); },
            [this] { provisioning.set_all_absent(); }};
  }

  WebServerOptions web_options() const {
    WebServerOptions web;
    web.address = options.address;
    web.port = options.port;
    if (const std::string host = link_host(options); host != "localhost") {
      web.hosts = {host};
    }
    web.most_clients = 0;
    // A browser opens up to six connections, and a class joins at the same time, often from one address.
    web.more_connections = 8 * options.most + 200;
    web.certificate = options.certificate;
    web.key = options.key;
    return web;
  }

  WebHandlers web_handlers() {
    WebHandlers handlers;
    handlers.get = [this](const std::string& path) { return options.file(path); };
    handlers.post = [this](WebPost post, std::function<void(WebContent)> answer) {
      log_in(std::move(post), std::move(answer));
    };
    handlers.policy = [this](std::string_view host) { return policy(host); };
    return handlers;
  }

  bool secure() const { return !options.certificate.empty(); }
  std::string web_broker(std::string_view host) const {
    return (secure() ? "wss://" : "ws://") + name_of(host) + ":" + std::to_string(broker->web_port());
  }
  std::string tcp_broker(std::string_view host) const {
    return (secure() ? "mqtts://" : "mqtt://") + name_of(host) + ":" + std::to_string(broker->port());
  }

  std::string policy(std::string_view host) const {
    return "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; "
           "font-src 'self'; worker-src 'self'; connect-src 'self' blob: data: https: " +
           web_broker(host) + "; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
  }

  void log_in(WebPost post, std::function<void(WebContent)> answer) {
    if (post.path != "/room/enter") {
      answer(plain_text(kNotFound, "There is nothing here."));
      return;
    }
    // Forms on other web sites cannot send this type.
    if (!post.type.starts_with("application/json")) {
      answer(plain_text(kWrongType, "The request must be JSON: application/json."));
      return;
    }
    provisioning.request(
        post.body, post.address,
        [this, host = post.host, answer](const std::optional<Provisioning::Grant>& grant) {
          answer(grant ? answer_of(*grant, host)
                       : plain_text(kUnavailable, "The broker is busy. Try again in a moment."));
        });
  }

  WebContent answer_of(const Provisioning::Grant& grant, const std::string& host) const {
    if (grant.result != LoginResult::accepted) {
      return plain_text(static_cast<unsigned>(grant.result), text_of(grant.result));
    }
    nlohmann::json roles = {"watch"};
    if (!grant.participant.empty()) {
      roles = {"speak", "board"};
      if (grant.chair) {
        roles.push_back("chair");
      }
    }
    nlohmann::json json = {{"user", grant.account.user},
                           {"password", grant.account.password},
                           {"participant", nullptr},
                           {"mqtt", web_broker(host)},
                           {"tcp", tcp_broker(host)},
                           {"topic", topic_base(meeting)},
                           {"roles", roles},
                           {"looks", options.looks}};
    if (!grant.participant.empty()) {
      json["participant"] = grant.participant;
      json["return"] = grant.rejoin;
    }
    WebContent content;
    content.bytes = std::make_shared<const std::string>(json.dump());
    content.type = "application/json";
    return content;
  }

  const HostOptions options;
  const Report report;
  const MeetingAddress meeting;
  SecretsFile file;
  const MeetingSecrets secrets;
  const BrokerAccount service_key;
  Provisioning provisioning;
  std::optional<HostedBroker> broker;
  std::optional<MeetingService> service;
  // Ends the thread of `provisioning` before the two above, which it uses, even if the constructor fails.
  const std::unique_ptr<Provisioning, void (*)(Provisioning*)> closed_provisioning{
      &provisioning, [](Provisioning* p) { p->close(); }};
  std::optional<WebServer> server;
};

void check_name(const std::string& name) {
  if (!is_topic_segment(name)) {
    throw Error(ErrorKind::usage, "a meeting cannot be called '" + name + "'",
                "A name consists of 1 to 32 lower-case letters, digits, _ and -; --title may be any text.");
  }
}

MeetingHost::MeetingHost(HostOptions options, Report report)
    : state_(std::make_unique<State>(std::move(options), std::move(report))) {}

MeetingHost::~MeetingHost() = default;

std::string MeetingHost::page() const {
  const std::string host = link_host(state_->options);
  return (state_->secure() ? "https://" : "http://") + host +
         (host.find(':') == std::string::npos ? ":" + std::to_string(port()) : "") + "/room";
}

std::string MeetingHost::speak_link() const {
  return page() + "#k=" + state_->secrets.speak;
}

std::string MeetingHost::watch_link() const {
  return page() + "#k=" + state_->secrets.watch;
}

std::string MeetingHost::chair_link() const {
  return page() + "#k=" + state_->secrets.chair;
}

std::uint16_t MeetingHost::port() const {
  return state_->server->port();
}

std::uint16_t MeetingHost::mqtt_port() const {
  return state_->broker->port();
}

std::uint16_t MeetingHost::web_port() const {
  return state_->broker->web_port();
}

pid_t MeetingHost::broker() const {
  return state_->broker->process();
}

}  // namespace telemime::meeting
