// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <future>
#include <thread>
#include <utility>

#include "meeting/transport/login.h"
#include "meeting/transport/senders.h"
#include "telemime/core/errors.h"
#include "telemime/streaming/resolve.h"

namespace telemime::meeting {
namespace {

constexpr std::chrono::milliseconds kLongestLogin{30000};  // including the lookup of the host

/// The output for these credentials, with the options of the link.
MeetingOutput output_of(const SendUrl& link, const Credentials& credentials) {
  SendUrl url = parse_url(credentials.broker, "mqtt://localhost:1883");
  url.text = link.text;
  url.user = credentials.user;
  url.password = credentials.password;
  url.path = credentials.topic.substr(1);  // of "r/tenant/meeting"
  url.options = link.options;
  std::erase_if(url.options, [](const auto& option) { return option.first == "mirror"; });
  MeetingOutput output = meeting_output_of(url);
  output.participant = credentials.participant;
  if (!find_option(url, "name")) {
    output.name = credentials.participant;
  }
  return output;
}

/// Logs in by a link, then takes part like MeetingLink.
class LoginLink final : public Link {
 public:
  LoginLink(SendLoop& loop, SendUrl url, LinkLogin login)
      : loop_(loop), url_(std::move(url)), login_(std::move(login)) {}

  void open() override {
    // Where the broker cannot be reached, the account is kept for a while: logins are limited for all who
    // share an address.
    constexpr std::chrono::seconds kAccountIsKept(60);
    const auto now = std::chrono::steady_clock::now();
    if (!logged_in_ || now - *logged_in_ > kAccountIsKept) {
      enter();
      logged_in_ = now;
    }
    link_->open();
    logged_in_.reset();
  }
  void person(const std::shared_ptr<const StreamHeader>& person) override { link_->person(person); }
  bool frame(const MotionFrame& frame, double taken) override { return link_->frame(frame, taken); }
  void close() noexcept override {
    if (link_) {
      link_->close();
    }
  }

 private:
  void enter() {
    try {
      const Credentials credentials = log_in();
      if (credentials.participant.empty()) {
        throw LinkBroken("this link is only for watching");
      }
      login_.rejoin = credentials.rejoin;
      // With the same account the session stays the same: to the others it was only an interruption.
      if (!link_ || credentials.broker != credentials_.broker || credentials.user != credentials_.user ||
          credentials.password != credentials_.password) {
        link_ = std::make_unique<MeetingLink>(loop_, output_of(url_, credentials));
        credentials_ = credentials;
      }
    } catch (const Error& e) {
      std::string text = e.what();
      std::replace(text.begin(), text.end(), '\n', ' ');
      throw LinkBroken(text);
    }
  }

  // In a thread that is joined before this returns: OpenSSL, which it uses, is cleaned up at the program's
  // end.
  Credentials log_in() {
    LinkLogin login = login_;
    login.addresses = resolve(loop_, url_.host);
    std::packaged_task<Credentials()> task([&login] { return log_in_by_link(login); });
    std::future<Credentials> result = task.get_future();
    const std::jthread thread([&login, &task, wake = loop_.waker()](const std::stop_token& stop) {
      login.stopped = [&stop] { return stop.stop_requested(); };
      task();
      wake();
    });
    const auto ready = [&] { return result.wait_for(std::chrono::seconds(0)) == std::future_status::ready; };
    if (!loop_.wait(ready, kLongestLogin)) {
      throw LinkBroken("the meeting's server does not answer");
    }
    return result.get();
  }

  SendLoop& loop_;
  const SendUrl url_;
  LinkLogin login_;
  Credentials credentials_;
  std::optional<std::chrono::steady_clock::time_point> logged_in_;  ///< since then the broker was not reached
  std::unique_ptr<MeetingLink> link_;
};

}  // namespace

std::unique_ptr<Sender> make_link_sender(const SendUrl& url) {
  check_options(url, {"name", "look", "seat", "ca", "mirror"});
  if (url.password.empty()) {
    throw Error(ErrorKind::usage, "the output \"" + url.text + "\" has no secret after \"#k=\"",
                "Secrets are not stored. Give the whole link again.");
  }
  if (url.path != "/room") {
    throw Error(ErrorKind::usage, "the output \"" + url.text + "\" is not the link of a meeting",
                "Write it like http://localhost:7080/room#k=SECRET.");
  }
  const bool tls = url.scheme == "https";
  // Checks the options now, and not only after the login.
  const Credentials example{.broker = tls ? "mqtts://localhost" : "mqtt://localhost",
                            .user = "x.x",
                            .password = "x",
                            .topic = "r/x/x",
                            .participant = "x",
                            .rejoin = {}};
  LinkLogin login;
  login.link = url.scheme + "://" + host_and_port(url.host, url.port.value_or(tls ? kHttpsPort : kHttpPort)) +
               url.path + "#k=" + url.password;
  login.ca = output_of(url, example).server.ca_file.value_or("");
  SendUrl shown = url;
  shown.password.clear();
  return make_queued_sender(shown,
                            [&](SendLoop& loop) { return std::make_unique<LoginLink>(loop, shown, login); });
}

}  // namespace telemime::meeting
