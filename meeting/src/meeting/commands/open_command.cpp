// SPDX-License-Identifier: Apache-2.0
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

#include "cli/interrupt.h"
#include "meeting/commands/commands.h"
#include "meeting/hosting/host.h"
#include "meeting/hosting/secrets.h"

namespace telemime::meeting {
namespace {

struct OpenArguments {
  HostOptions host;
  std::filesystem::path avatars;
  double seconds = 0.0;
  bool quiet = false;
};

void print_links(const MeetingHost& host, const std::string& title, bool quiet) {
  if (quiet) {
    std::cout << "to speak: " << host.speak_link() << "\nto watch: " << host.watch_link()
              << "\nto chair: " << host.chair_link() << std::endl;
    return;
  }
  const std::string ca =
      host.page().starts_with("https://") ? "  (?ca=FILE before # names an authority)" : "";
  std::cout << "Meeting \"" << title << "\" is open: " << host.page() << " (press Ctrl-C to close it)\n"
            << "Anyone with a link can join. Share each link only with those it is meant for.\n"
            << "to speak: " << host.speak_link() << '\n'
            << "to watch: " << host.watch_link() << '\n'
            << "to chair: " << host.chair_link() << '\n'
            << "with a tracker: telemime live --send '" << host.speak_link() << "'" << ca << '\n'
            << "MQTT at port " << host.mqtt_port() << ", over WebSocket at port " << host.web_port()
            << std::endl;
}

void run_meeting(OpenArguments arguments, const OpenFiles& open_files) {
  // Links are kept from one run to the next.
  HostOptions& options = arguments.host;
  check_name(options.name);
  if (options.secrets.empty()) {
    options.secrets = default_secrets_file(options.name, std::getenv("XDG_STATE_HOME"), std::getenv("HOME"));
  }

  MeetingFiles files = open_files(arguments.avatars);
  options.looks = std::move(files.looks);
  options.file = std::move(files.get);

  std::mutex mutex;
  const auto report = [&mutex](const std::string& text) {
    const std::lock_guard lock(mutex);
    std::cerr << text << '\n';
  };

  note_interrupts();
  const MeetingHost host(options, report);
  print_links(host, options.title, arguments.quiet);
  if (!options.address.starts_with("127.") && options.address != "localhost" && options.certificate.empty()) {
    report(
        "Other computers can reach this meeting, and nothing is encrypted: anyone on the same network can "
        "listen and join.\n  --certificate FILE --key FILE encrypt it.");
  }

  const auto start = std::chrono::steady_clock::now();
  while (!interrupted()) {
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    if (arguments.seconds > 0.0 && elapsed.count() >= arguments.seconds) {
      break;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
}

}  // namespace

void add_meeting_command(CLI::App& app, OpenFiles open_files) {
  CLI::App* const command =
      app.add_subcommand("meeting", "Open a shared 3-D space on this computer; record or replay one");
  command->require_subcommand(0, 1);
  const auto arguments = std::make_shared<OpenArguments>();
  HostOptions& host = arguments->host;
  command->add_option("--title", host.title, "Title shown to the participants.")->capture_default_str();
  command
      ->add_option("--name", host.name, "Name in addresses and topics: lower-case letters, digits, _ and -.")
      ->capture_default_str();
  command->add_option("--seats", host.seats, "Number of chairs at the table.")->capture_default_str();
  command->add_option("--most", host.most, "Maximum number of participants.")->capture_default_str();
  command->add_option("--port", host.port, "Port of the page.")->capture_default_str();
  command->add_option("--address", host.address,
                      "Address to listen at [127.0.0.1: this computer only]; 0.0.0.0: all networks.");
  command->add_option("--host", host.host, "Name of this computer in the links.");
  command->add_option("--mqtt-port", host.broker.port,
                      "Port for trackers [1883, with TLS 8883, or a free one].");
  command->add_option("--ws-port", host.broker.web_port, "Port for browsers [9001, or a free one].");
  command->add_option("--certificate", host.certificate,
                      "PEM file of a certificate; encrypts everything (TLS).");
  command->add_option("--key", host.key, "PEM file of the certificate's key.");
  command->add_option("--secrets", host.secrets,
                      "File that keeps the links [~/.local/state/telemime/rooms/NAME.json].");
  command->add_flag("--new-links", host.new_links, "Create new links; all earlier ones stop working.");
  command->add_option("--avatars", arguments->avatars, "Folder with more avatars, LOOK.vrm.");
  command->add_option("--mosquitto", host.broker.program, "Path of the Mosquitto broker.");
  command->add_option("--seconds", arguments->seconds, "Stop after this many seconds [0: never].");
  command->add_flag("--quiet", arguments->quiet, "Print only links, warnings and errors.");
  add_recording_commands(*command);
  add_people_command(*command);
  command->callback([command, arguments, open_files = std::move(open_files)] {
    if (command->get_subcommands().empty()) {
      run_meeting(*arguments, open_files);
    }
  });
}

}  // namespace telemime::meeting
