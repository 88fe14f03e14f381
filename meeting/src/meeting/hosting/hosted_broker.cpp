// SPDX-License-Identifier: Apache-2.0
#include "meeting/hosting/hosted_broker.h"

#include <pwd.h>
#include <sys/un.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <thread>
#include <utility>

#include "meeting/hosting/broker_probe.h"
#include "meeting/hosting/crypto.h"
#include "meeting/hosting/ports.h"
#include "meeting/hosting/private_file.h"
#include "telemime/core/errors.h"

namespace telemime::meeting {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::uint16_t kMqtt = 1883;
constexpr std::uint16_t kMqtts = 8883;
constexpr std::uint16_t kWeb = 9001;
constexpr std::chrono::seconds kStarts{10};
constexpr std::chrono::seconds kReloads{10};
constexpr std::chrono::milliseconds kAskAgain{10};
constexpr std::chrono::milliseconds kSignalAgain{500};
constexpr int kMostStarts = 5;

// It would become somebody else when root starts it, and could not read its files.
std::string user_when_root() {
  const passwd* const entry = ::geteuid() == 0 ? ::getpwuid(0) : nullptr;
  return entry == nullptr ? "" : entry->pw_name;
}

/// The port that was asked for, the usual one, or a free one.
std::uint16_t choose_port(const std::string& address, std::optional<std::uint16_t> asked, std::uint16_t usual,
                          const std::string& what, const std::string& option,
                          const HostedBroker::Tell& tell) {
  const std::uint16_t wanted = asked.value_or(usual);
  if (const auto port = free_port(address, wanted)) {
    return *port;
  }
  if (asked) {
    throw Error(ErrorKind::output, "port " + std::to_string(wanted) + " is taken by another program",
                "End that program, or choose another port for " + what + ": " + option + ".");
  }
  const auto other = free_port(address, 0);
  if (!other) {
    throw Error(ErrorKind::output, "nothing can be served at " + address,
                "127.0.0.1 is for this computer alone, 0.0.0.0 for whoever can reach it.");
  }
  tell("port " + std::to_string(wanted) + " is taken by another program: " + what + " uses " +
       std::to_string(*other));
  return *other;
}

/// A copy that only its user may read: Mosquitto reads these files anew with the accounts, and what came to
/// stand there later would be no longer what the page has.
std::filesystem::path keep_copy(const std::filesystem::path& file, const std::filesystem::path& copy) {
  std::ifstream in(file, std::ios::binary);
  const std::string content{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  if (!in.is_open() || in.bad()) {
    throw Error(ErrorKind::usage, file.string() + " cannot be read");
  }
  write_private_file(copy, content);
  return copy;
}

}  // namespace

HostedBroker::HostedBroker(BrokerPlace place, const MeetingAddress& meeting,
                           std::vector<BrokerAccount> accounts, Tell tell)
    : meeting_(meeting.meeting), tell_(std::move(tell)), accounts_(std::move(accounts)) {
  const std::filesystem::path program = find_mosquitto(place.program, std::getenv("PATH"));
  if (socket().string().size() >= sizeof(sockaddr_un::sun_path)) {
    throw Error(ErrorKind::output,
                "the folder of temporary files has too long a name: " + folder_.path().string(),
                "Set TMPDIR to a folder with a shorter one.");
  }
  settings_.folder = folder_.path();
  settings_.address = place.address;
  if (!place.certificate.empty()) {
    settings_.certificate = keep_copy(place.certificate, folder_.path() / "certificate.pem");
    settings_.key = keep_copy(place.key, folder_.path() / "key.pem");
  }
  settings_.most_connections = place.most_connections;
  settings_.user = user_when_root();
  write_accounts();
  // Between the look and the start somebody else may take a port that nobody asked for.
  for (int left = kMostStarts; left > 0; --left) {
    settings_.port = choose_port(place.address, place.port, place.certificate.empty() ? kMqtt : kMqtts,
                                 "MQTT", "--mqtt-port", tell_);
    settings_.web_port =
        choose_port(place.address, place.web_port, kWeb, "MQTT over WebSocket", "--ws-port", tell_);
    if (start(program)) {
      process_->keep_running();
      return;
    }
    const bool taken = process_->last_words().find("in use") != std::string::npos;
    if (!taken || left == 1) {
      throw Error(ErrorKind::output, "the broker does not start: " + why_not());
    }
  }
}

bool HostedBroker::start(const std::filesystem::path& program) {
  write_private_file(broker_configuration_file(settings_.folder), broker_configuration(settings_));
  process_ = std::make_unique<BrokerProcess>(program, broker_configuration_file(settings_.folder), tell_);
  return comes_up();
}

bool HostedBroker::comes_up() const {
  const auto until = Clock::now() + kStarts;
  while (!process_->has_ended() && Clock::now() < until) {
    if (knows_newest()) {
      return true;
    }
    std::this_thread::sleep_for(kAskAgain);
  }
  return false;
}

std::string HostedBroker::why_not() const {
  const std::string words = process_->last_words();
  const std::string ending = process_->has_ended() ? process_->ending() : "no answer";
  return words.empty() ? ending : words;
}

void HostedBroker::write_accounts() {
  ++generation_;
  newest_ = {meeting_ + ".news-" + std::to_string(generation_), random_secret(), {}, {}};
  std::string passwords = password_line(newest_.user, newest_.password) + "\n";
  for (const BrokerAccount& account : accounts_) {
    passwords += password_line(account.user, account.password) + "\n";
  }
  write_private_file(broker_access_file(folder_.path()), access_rules(accounts_));
  write_private_file(broker_password_file(folder_.path()), passwords);
}

bool HostedBroker::knows_newest() const {
  return ask_broker(socket(), newest_.user, newest_.password) == BrokerAnswer::accepted;
}

// Mosquitto says nothing when it has read its files anew. An account that was not in the files before is the
// sign: it is let in only afterwards. SIGHUP would kill a broker that does not expect it yet; one that
// refuses us has got so far.
bool HostedBroker::set_accounts(std::vector<BrokerAccount> accounts) {
  accounts_ = std::move(accounts);
  write_accounts();
  const auto until = Clock::now() + kReloads;
  std::optional<std::pair<std::uint64_t, Clock::time_point>> told;
  while (Clock::now() < until && !given_up_) {
    const std::uint64_t run = process_->run();
    const BrokerAnswer answer = ask_broker(socket(), newest_.user, newest_.password);
    if (answer == BrokerAnswer::accepted) {
      return true;
    }
    const auto now = Clock::now();
    const bool due = !told || told->first != run || now - told->second > kSignalAgain;
    if (answer == BrokerAnswer::refused && due && process_->signal(run, SIGHUP)) {
      told = {run, now};
    }
    std::this_thread::sleep_for(kAskAgain);
  }
  return false;
}

}  // namespace telemime::meeting
