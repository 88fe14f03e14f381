// SPDX-License-Identifier: Apache-2.0
#include "meeting/hosting/host.h"

#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "meeting/hosting/ports.h"
#include "meeting/hosting/provisioning.h"
#include "meeting/hosting/secrets.h"
#include "meeting/hosting/service.h"
#include "telemime/core/errors.h"
#include "telemime/streaming/web_tls.h"

namespace telemime::meeting {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kMostParticipants = 500;
constexpr std::size_t kLongestTitle = 200;  // bytes
constexpr unsigned kNotFound = 404;
constexpr unsigned kWrongType = 415;
constexpr unsigned kNotNow = 503;

WebContent words(unsigned status, const std::string& text) {
  WebContent content;
  content.bytes = std::make_shared<const std::string>(text + "\n");
  content.type = "text/plain; charset=utf-8";
  content.status = status;
  return content;
}

/// "name:7080" without its port. The broker listens at IPv4 addresses alone, so that [::1] is its name.
std::string name_of(std::string_view host) {
  return host.starts_with('[') ? "localhost" : std::string(host.substr(0, host.find(':')));
}

std::string words_for(LoginResult answer) {
  switch (answer) {
    case LoginResult::wrong_link:
      return "This link does not open the room.";
    case LoginResult::full:
      return "All accounts of the room are taken.";
    case LoginResult::locked:
      return "The room is locked.";
    case LoginResult::too_many_tries:
      return "Too many tries. Wait a minute.";
    default:
      return "This cannot be understood.";
  }
}

HostOptions checked(HostOptions plan) {
  check_name(plan.name);
  if (plan.seats < 1 || plan.seats > 100 || plan.most < 1 || plan.most > kMostParticipants) {
    throw Error(ErrorKind::usage, "a room has 1 to 100 seats, and at most " +
                                      std::to_string(kMostParticipants) + " participants");
  }
  if (plan.title.size() > kLongestTitle) {
    throw Error(ErrorKind::usage, "the title is longer than " + std::to_string(kLongestTitle) + " bytes");
  }
  if (plan.certificate.empty() != plan.key.empty()) {
    throw Error(ErrorKind::usage, "TLS needs a certificate and its key",
                "Give both: --certificate FILE --key FILE.");
  }
  if (plan.address == "localhost") {
    plan.address = "127.0.0.1";
  }
  plan.broker.address = plan.address;
  plan.broker.certificate = plan.certificate;
  plan.broker.key = plan.key;
  // A participant has a page, a tracker, and now and then an old connection beside a new one.
  plan.broker.most_connections = static_cast<int>(4 * plan.most) + 200;
  return plan;
}

MeetingSecrets secrets_of(SecretsFile& file, bool new_ones) {
  if (!new_ones) {
    return file.load();
  }
  MeetingSecrets secrets = new_secrets();
  file.save(secrets);
  return secrets;
}

std::string link_host(const HostOptions& plan) {
  if (!plan.host.empty()) {
    return plan.host;
  }
  if (plan.address == "0.0.0.0") {
    return own_address();
  }
  return plan.address == "127.0.0.1" ? "localhost" : plan.address;
}

}  // namespace

struct MeetingHost::State {
  State(HostOptions asked, Tell say)
      : plan(checked(std::move(asked))),
        tell(std::move(say)),
        meeting{plan.tenant, plan.name},
        file(plan.secrets),
        secrets(secrets_of(file, plan.new_links)),
        service_key(service_account(meeting)),
        desk(meeting, secrets, rules(), service_key, file, desk_hooks()) {
    if (!plan.certificate.empty()) {
      web_tls(plan.certificate, plan.key);  // wrong files are told before anything is started
    }
    broker.emplace(plan.broker, meeting, desk.accounts(),
                   [this](const std::string& text) { tell(Level::warning, text); });
    MeetingInfo info;
    info.title = plan.title;
    info.seats = plan.seats;
    service.emplace(broker->socket(), meeting, service_key, info, service_hooks());
    desk.open(*broker);
    server.emplace(web_options(), web_handlers());
  }
  ~State() {
    if (server) {
      server->stop();
    }
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  LoginRules rules() const {
    LoginRules rules;
    rules.most = plan.most;
    rules.keeps_seat = plan.keeps_seat;
    return rules;
  }

  Provisioning::Hooks desk_hooks() {
    return {[this](std::vector<std::string> chairs, const std::vector<std::string>& freed) {
              service->set_chairs(std::move(chairs));
              service->forget(freed);
            },
            [this](const std::string& text) { tell(Level::warning, text); }};
  }

  MeetingService::Hooks service_hooks() {
    return {[this](const std::string& id, bool here) { desk.seen(id, here); },
            [this](const MeetingInfo& info) { desk.lock(info.locked); }, [this] { desk.set_all_absent(); }};
  }

  WebServerOptions web_options() const {
    WebServerOptions options;
    options.address = plan.address;
    options.port = plan.port;
    if (const std::string host = link_host(plan); host != "localhost") {
      options.hosts = {host};
    }
    options.most_clients = 0;
    // A browser opens up to six at once, and a class comes in at once, often from one address.
    options.more_connections = 8 * plan.most + 200;
    options.certificate = plan.certificate;
    options.key = plan.key;
    return options;
  }

  WebHandlers web_handlers() {
    WebHandlers handlers;
    handlers.get = [this](const std::string& path) { return plan.file(path); };
    handlers.post = [this](WebPost post, std::function<void(WebContent)> answer) {
      enter(std::move(post), std::move(answer));
    };
    handlers.policy = [this](std::string_view host) { return policy(host); };
    return handlers;
  }

  bool secure() const { return !plan.certificate.empty(); }
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

  void enter(WebPost post, std::function<void(WebContent)> answer) {
    if (post.path != "/room/enter") {
      answer(words(kNotFound, "There is nothing here."));
      return;
    }
    // Forms of other web sites cannot send this type.
    if (!post.type.starts_with("application/json")) {
      answer(words(kWrongType, "The question is JSON: application/json."));
      return;
    }
    desk.ask(post.body, post.address,
             [this, host = post.host, answer](const std::optional<Provisioning::Ticket>& ticket) {
               answer(ticket ? entered(*ticket, host)
                             : words(kNotNow, "The room's broker is busy. Try again in a moment."));
             });
  }

  WebContent entered(const Provisioning::Ticket& ticket, const std::string& host) const {
    if (ticket.answer != LoginResult::log_in) {
      return words(static_cast<unsigned>(ticket.answer), words_for(ticket.answer));
    }
    Json roles = {"watch"};
    if (!ticket.participant.empty()) {
      roles = {"speak", "board"};
      if (ticket.chair) {
        roles.push_back("chair");
      }
    }
    Json json = {{"user", ticket.account.user},
                 {"password", ticket.account.password},
                 {"participant", nullptr},
                 {"mqtt", web_broker(host)},
                 {"tcp", tcp_broker(host)},
                 {"topic", topic_base(meeting)},
                 {"roles", roles},
                 {"looks", plan.looks}};
    if (!ticket.participant.empty()) {
      json["participant"] = ticket.participant;
      json["return"] = ticket.rejoin;
    }
    WebContent content;
    content.bytes = std::make_shared<const std::string>(json.dump());
    content.type = "application/json";
    return content;
  }

  const HostOptions plan;
  const Tell tell;
  const MeetingAddress meeting;
  SecretsFile file;
  const MeetingSecrets secrets;
  const BrokerAccount service_key;
  Provisioning desk;
  std::optional<HostedBroker> broker;
  std::optional<MeetingService> service;
  // Its thread uses the two above, also when the page cannot be served after all.
  const std::unique_ptr<Provisioning, void (*)(Provisioning*)> closed_desk{
      &desk, [](Provisioning* d) { d->close(); }};
  std::optional<WebServer> server;
};

void check_name(const std::string& name) {
  if (!is_topic_segment(name)) {
    throw Error(ErrorKind::usage, "a meeting cannot be called '" + name + "'",
                "A name consists of 1 to 32 lower-case letters, digits, _ and -; --title may be any text.");
  }
}

MeetingHost::MeetingHost(HostOptions plan, Tell tell)
    : state_(std::make_unique<State>(std::move(plan), std::move(tell))) {}

MeetingHost::~MeetingHost() = default;

std::string MeetingHost::page() const {
  const std::string host = link_host(state_->plan);
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
