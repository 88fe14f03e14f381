// SPDX-License-Identifier: Apache-2.0
#include "meeting/hosting/hosted_broker.h"

#include <mosquitto.h>
#include <pwd.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string_view>
#include <thread>
#include <utility>

#include "meeting/hosting/crypto.h"
#include "meeting/hosting/ports.h"
#include "meeting/transport/mqtt_connection.h"
#include "telemime/core/errors.h"
#include "telemime/core/files.h"

namespace telemime::meeting {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::uint16_t kMqtt = 1883;
constexpr std::uint16_t kMqtts = 8883;
constexpr std::uint16_t kWeb = 9001;
constexpr std::chrono::seconds kStarts{10};
constexpr std::chrono::seconds kReloads{10};
constexpr std::chrono::milliseconds kProbeInterval{10};
constexpr std::chrono::milliseconds kSignalInterval{500};
constexpr int kMostStarts = 5;

// Started by root, it would change to another user and could not read its files.
std::string user_when_root() {
  const passwd* const entry = ::geteuid() == 0 ? ::getpwuid(0) : nullptr;
  return entry == nullptr ? "" : entry->pw_name;
}

/// The requested port, or the usual one, or a free one; none of those that this meeting uses for something
/// else (`own`; 0 is none).
std::uint16_t choose_port(const std::string& address, std::optional<std::uint16_t> requested,
                          std::uint16_t usual, const std::array<std::uint16_t, 2>& own,
                          const std::string& what, const std::string& option,
                          const HostedBroker::Report& report) {
  const std::uint16_t wanted = requested.value_or(usual);
  const bool is_own = wanted != 0 && std::find(own.begin(), own.end(), wanted) != own.end();
  if (is_own && requested) {
    throw Error(ErrorKind::usage, "port " + std::to_string(wanted) + " is requested twice",
                "Choose another port for " + what + ": " + option + ".");
  }
  if (const auto port = is_own ? std::nullopt : free_port(address, wanted)) {
    return *port;
  }
  if (requested) {
    throw Error(ErrorKind::output, "port " + std::to_string(wanted) + " is taken by another program",
                "End that program, or choose another port for " + what + ": " + option + ".");
  }
  const auto other = free_port(address, 0);
  if (!other) {
    throw Error(ErrorKind::output, "nothing can be served at " + address,
                "127.0.0.1 is this computer only, 0.0.0.0 all networks.");
  }
  report("port " + std::to_string(wanted) +
         (is_own ? " is in use by this meeting: " : " is taken by another program: ") + what + " uses " +
         std::to_string(*other));
  return *other;
}

/// Mosquitto's words; those of libwebsockets for its port name no reason.
bool says_that_a_port_is_taken(std::string_view words) {
  return words.find("in use") != std::string_view::npos ||
         words.find("Unable to create websockets listener") != std::string_view::npos;
}

/// A copy that only its user can read. Mosquitto reads these files again with each set of accounts, but must
/// keep the certificate that the page has.
std::filesystem::path keep_copy(const std::filesystem::path& file, const std::filesystem::path& copy) {
  std::ifstream in(file, std::ios::binary);
  const std::string content{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  if (!in.is_open() || in.bad()) {
    throw Error(ErrorKind::usage, file.string() + " cannot be read");
  }
  write_private_file(copy, content);
  return copy;
}

enum class BrokerAnswer {
  accepted,  ///< it knows the account
  rejected,  ///< it is running and does not know the account
  none,      ///< it is not running (yet)
};

/// Connects once to the broker at this Unix socket, for at most a second.
BrokerAnswer probe_broker(const std::filesystem::path& socket, const BrokerAccount& account) {
  constexpr int kKeepAlive = 10;  // s
  constexpr std::chrono::seconds kPatience{1};
  const MqttLibrary library;
  std::optional<int> code;
  const MqttClient client(mosquitto_new(nullptr, /*clean_session=*/true, &code));
  mosquitto_int_option(client.get(), MOSQ_OPT_PROTOCOL_VERSION, MQTT_PROTOCOL_V311);
  mosquitto_username_pw_set(client.get(), account.user.c_str(), account.password.c_str());
  mosquitto_connect_callback_set(client.get(), [](mosquitto* /*client*/, void* result, int answer) {
    *static_cast<std::optional<int>*>(result) = answer;
  });
  const auto end = Clock::now() + kPatience;
  int state = mosquitto_connect(client.get(), socket.c_str(), 0, kKeepAlive);
  while (state == MOSQ_ERR_SUCCESS && !code && Clock::now() < end) {
    state = mosquitto_loop(client.get(), static_cast<int>(kProbeInterval.count()), 1);
  }
  mosquitto_disconnect(client.get());
  return !code ? BrokerAnswer::none : *code == 0 ? BrokerAnswer::accepted : BrokerAnswer::rejected;
}

}  // namespace

HostedBroker::HostedBroker(BrokerOptions options, const MeetingAddress& meeting,
                           std::vector<BrokerAccount> accounts, Report report)
    : meeting_(meeting.meeting), report_(std::move(report)), accounts_(std::move(accounts)) {
  const std::filesystem::path program = find_mosquitto(options.program, std::getenv("PATH"));
  if (socket().string().size() >= sizeof(sockaddr_un::sun_path)) {
    throw Error(ErrorKind::output, "the path of the temporary folder is too long: " + folder_.path().string(),
                "Set TMPDIR to a folder with a shorter path.");
  }
  settings_.folder = folder_.path();
  settings_.address = options.address;
  if (!options.certificate.empty()) {
    settings_.certificate = keep_copy(options.certificate, folder_.path() / "certificate.pem");
    settings_.key = keep_copy(options.key, folder_.path() / "key.pem");
  }
  settings_.most_connections = options.most_connections;
  settings_.user = user_when_root();
  write_accounts();
  // Between the check and the start, another program may take a port: then choose again.
  for (int left = kMostStarts; left > 0; --left) {
    settings_.port =
        choose_port(options.address, options.port, options.certificate.empty() ? kMqtt : kMqtts,
                    {options.page_port, options.web_port.value_or(0)}, "MQTT", "--mqtt-port", report_);
    settings_.web_port =
        choose_port(options.address, options.web_port, kWeb, {options.page_port, settings_.port},
                    "MQTT over WebSocket", "--ws-port", report_);
    if (start(program)) {
      process_->keep_running();
      return;
    }
    if (left == 1 || !says_that_a_port_is_taken(process_->last_output())) {
      throw Error(ErrorKind::output, "the broker does not start: " + failure());
    }
  }
}

bool HostedBroker::start(const std::filesystem::path& program) {
  write_private_file(broker_configuration_file(settings_.folder), broker_configuration(settings_));
  process_ = std::make_unique<BrokerProcess>(program, broker_configuration_file(settings_.folder), report_);
  return comes_up();
}

bool HostedBroker::comes_up() const {
  const auto until = Clock::now() + kStarts;
  while (!process_->has_ended() && Clock::now() < until) {
    if (knows_accounts()) {
      return true;
    }
    std::this_thread::sleep_for(kProbeInterval);
  }
  return false;
}

std::string HostedBroker::failure() const {
  const std::string text = process_->last_output();
  const std::string ending = process_->has_ended() ? process_->ending() : "no answer";
  return text.empty() ? ending : text;
}

void HostedBroker::write_accounts() {
  ++generation_;
  probe_ = {meeting_ + ".probe-" + std::to_string(generation_), random_secret(), {}, {}};
  std::string passwords = password_line(probe_.user, probe_.password) + "\n";
  for (const BrokerAccount& account : accounts_) {
    passwords += password_line(account.user, account.password) + "\n";
  }
  write_private_file(broker_access_file(folder_.path()), access_rules(accounts_));
  write_private_file(broker_password_file(folder_.path()), passwords);
}

bool HostedBroker::knows_accounts() const {
  return probe_broker(socket(), probe_) == BrokerAnswer::accepted;
}

// Mosquitto does not report when it has read its files again. An account that was in no earlier set shows it:
// the broker accepts it only afterwards. SIGHUP would kill a broker that is still starting; one that rejects
// an account is running.
bool HostedBroker::set_accounts(std::vector<BrokerAccount> accounts) {
  accounts_ = std::move(accounts);
  write_accounts();
  const auto until = Clock::now() + kReloads;
  std::optional<std::pair<std::uint64_t, Clock::time_point>> signalled;
  while (Clock::now() < until && !given_up_) {
    const std::uint64_t run = process_->run();
    const BrokerAnswer answer = probe_broker(socket(), probe_);
    if (answer == BrokerAnswer::accepted) {
      return true;
    }
    const auto now = Clock::now();
    const bool due = !signalled || signalled->first != run || now - signalled->second > kSignalInterval;
    if (answer == BrokerAnswer::rejected && due && process_->signal(run, SIGHUP)) {
      signalled = {run, now};
    }
    std::this_thread::sleep_for(kProbeInterval);
  }
  return false;
}

}  // namespace telemime::meeting
