// SPDX-License-Identifier: Apache-2.0
#include "meeting/transport/link_sender.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <functional>
#include <future>
#include <optional>
#include <thread>
#include <utility>

#include "meeting/transport/link_login.h"
#include "meeting/transport/meeting_link.h"
#include "meeting/transport/mqtt_sender.h"
#include "telemime/core/errors.h"
#include "telemime/streaming/resolve.h"
#include "telemime/streaming/send_queue.h"

namespace telemime::meeting {
namespace {

constexpr std::chrono::milliseconds kLongestEntry{30000};  // names are looked up, too

/// What takes part with that key, as the link's options say.
MeetingOutput output_of(const SendUrl& link, const Credentials& key) {
  SendUrl url = parse_url(key.broker, "mqtt://localhost:1883");
  url.text = link.text;
  url.user = key.user;
  url.password = key.password;
  url.path = key.topic.substr(1);  // "r/tenant/room"
  url.options = link.options;
  std::erase_if(url.options, [](const auto& option) { return option.first == "mirror"; });
  MeetingOutput output = meeting_output_of(url);
  output.participant = key.participant;
  if (!free_option(url, "name")) {
    output.name = key.participant;
  }
  return output;
}

std::string in_one_line(std::string words) {
  std::replace(words.begin(), words.end(), '\n', ' ');
  return words;
}

/// A thread that is told to give up, and waited for.
class Visitor {
 public:
  Visitor(std::atomic<bool>& give_up, std::function<void()> work)
      : give_up_(give_up), thread_(std::move(work)) {}
  Visitor(const Visitor&) = delete;
  Visitor& operator=(const Visitor&) = delete;
  ~Visitor() {
    give_up_ = true;
    thread_.join();
  }

 private:
  std::atomic<bool>& give_up_;
  std::thread thread_;
};

/// Takes part by the key that the room's server gave.
class LoginLink final : public Link {
 public:
  LoginLink(SendLoop& loop, SendUrl url, LinkLogin entry)
      : loop_(loop), url_(std::move(url)), entry_(std::move(entry)) {}

  void open() override {
    const Credentials key = enter();
    if (key.participant.empty()) {
      throw LinkBroken("this link is only for watching");
    }
    entry_.rejoin = key.rejoin;
    // The same seat, the same session: to the others it is a break, and nobody new.
    if (!meeting_ || key.broker != key_.broker || key.user != key_.user || key.password != key_.password) {
      try {
        meeting_ = std::make_unique<MeetingLink>(loop_, output_of(url_, key));
      } catch (const Error& e) {
        throw LinkBroken(in_one_line(e.what()));
      }
      key_ = key;
    }
    meeting_->open();
  }
  void person(const std::shared_ptr<const StreamHeader>& person) override { meeting_->person(person); }
  bool frame(const MotionFrame& frame, double taken) override { return meeting_->frame(frame, taken); }
  void close() noexcept override {
    if (meeting_) {
      meeting_->close();
    }
  }

 private:
  // Not a thread that is left behind: OpenSSL, which it uses, is taken down when the program ends.
  Credentials enter() {
    std::atomic<bool> given_up = false;
    LinkLogin entry = entry_;
    entry.addresses = resolve(loop_, url_.host);
    entry.stopped = [&given_up] { return given_up.load(); };
    std::promise<Credentials> promise;
    std::future<Credentials> key = promise.get_future();
    const Visitor visitor(given_up, [&promise, &entry, wake = loop_.waker()] {
      try {
        promise.set_value(log_in_by_link(entry));
      } catch (...) {
        promise.set_exception(std::current_exception());
      }
      wake();
    });
    const auto ready = [&key] { return key.wait_for(std::chrono::seconds(0)) == std::future_status::ready; };
    if (!loop_.wait(ready, kLongestEntry)) {
      throw LinkBroken("the room's server does not answer");
    }
    try {
      return key.get();
    } catch (const Error& e) {
      throw LinkBroken(in_one_line(e.what()));
    }
  }

  SendLoop& loop_;
  const SendUrl url_;
  LinkLogin entry_;
  Credentials key_;
  std::unique_ptr<MeetingLink> meeting_;
};

}  // namespace

std::unique_ptr<Sender> make_link_sender(const SendUrl& url) {
  check_options(url, {"name", "look", "seat", "ca", "mirror"});
  require_host(url);
  if (url.password.empty()) {
    throw Error(ErrorKind::usage, "the output \"" + url.text + "\" has no secret of a room behind \"#k=\"",
                "Secrets are not kept. Give the whole link again, as it was shared.");
  }
  if (url.path != "/room") {
    throw Error(ErrorKind::usage, "the output \"" + url.text + "\" is no link to a room",
                "Write it like http://localhost:7080/room#k=INVITE.");
  }
  const bool tls = url.scheme == "https";
  // Mistakes in the options are told at once, not when somebody has opened the door.
  const Credentials tried{tls ? "mqtts://localhost" : "mqtt://localhost", "x.x", "x", "r/x/x", "x", {}, {}};
  LinkLogin entry;
  entry.link = url.scheme + "://" + host_and_port(url.host, url.port.value_or(tls ? kHttpsPort : 80)) +
               url.path + "#k=" + url.password;
  entry.ca = output_of(url, tried).server.ca_file.value_or("");
  SendUrl shown = url;
  shown.password.clear();
  return make_queued_sender(shown,
                            [&](SendLoop& loop) { return std::make_unique<LoginLink>(loop, shown, entry); });
}

}  // namespace telemime::meeting
