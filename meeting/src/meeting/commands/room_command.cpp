// SPDX-License-Identifier: Apache-2.0
#include "meeting/commands/room_command.h"

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "cli/data_folder.h"
#include "cli/interrupt.h"
#include "meeting/commands/room_people_command.h"
#include "meeting/commands/room_record_command.h"
#include "meeting/commands/room_replay_command.h"
#include "meeting/hosting/room_host.h"
#include "meeting/hosting/room_secrets.h"
#include "meeting/protocol/room_topic.h"
#include "telemime/core/errors.h"
#include "telemime/live/avatar_folder.h"
#include "telemime/live/live_files.h"

namespace telemime {
namespace {

struct RoomCommand {
  RoomPlan plan;
  std::filesystem::path avatars;
  double seconds = 0.0;
  bool quiet = false;
};

/// The looks to choose from: those of the program first, then the user's.
std::vector<std::string> all_looks(const AvatarFolder& shipped, const AvatarFolder& own) {
  std::vector<std::string> looks = shipped.looks();
  for (const std::string& look : own.looks()) {
    if (std::find(looks.begin(), looks.end(), look) == looks.end()) {
      looks.push_back(look);
    }
  }
  return looks;
}

void print_links(const RoomHost& room, const RoomCommand& command) {
  const std::string ca =
      room.page().starts_with("https://") ? "  (?ca=FILE before # names an authority)" : "";
  std::cout << "the room \"" << command.plan.title << "\" is open: " << room.page() << "   Ctrl-C ends\n"
            << "Who has a link comes in by it; share each with those whom it is for.\n"
            << "to speak: " << room.speak_link() << '\n'
            << "to watch: " << room.watch_link() << '\n'
            << "to chair: " << room.chair_link() << '\n'
            << "with a tracker: telemime live --send '" << room.speak_link() << "'" << ca << '\n'
            << "MQTT at port " << room.mqtt_port() << ", over WebSocket at " << room.web_port() << std::endl;
}

void run(RoomCommand command) {
  RoomPlan& plan = command.plan;
  if (plan.secrets.empty()) {
    if (!is_room_segment(plan.name)) {
      throw Error(ErrorKind::usage, "a room cannot be called '" + plan.name + "'",
                  "1 to 32 small letters, digits, _ and - are a name; --title may be any text.");
    }
    plan.secrets = default_secrets_file(plan.name, std::getenv("XDG_STATE_HOME"), std::getenv("HOME"));
  }
  const AvatarFolder own(command.avatars);
  const AvatarFolder shipped(avatar_folder());
  plan.looks = all_looks(shipped, own);
  plan.file = [&own, &shipped](const std::string& path) {
    auto file = own.file(path);
    return file ? file : room_file(path, shipped);
  };
  std::mutex mutex;
  const auto tell = [&mutex, quiet = command.quiet](RoomHost::Level level, const std::string& words) {
    if (!quiet || level != RoomHost::Level::info) {
      const std::lock_guard lock(mutex);
      std::cerr << words << '\n';
    }
  };
  note_interrupts();
  RoomHost room(plan, tell);
  print_links(room, command);
  if (!plan.address.starts_with("127.") && plan.address != "localhost" && plan.certificate.empty()) {
    tell(RoomHost::Level::warning,
         "the room is open to others, and nothing is encrypted: who is on the same network can listen, and "
         "come "
         "in\n  --certificate FILE --key FILE encrypt it.");
  }
  const auto start = std::chrono::steady_clock::now();
  while (!interrupted()) {
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start;
    if (command.seconds > 0.0 && passed.count() >= command.seconds) {
      break;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
}

}  // namespace

void add_room_command(CLI::App& app) {
  CLI::App* const command =
      app.add_subcommand("room", "Open a room that several people share, on this machine");
  command->require_subcommand(0, 1);
  const auto options = std::make_shared<RoomCommand>();
  RoomPlan& plan = options->plan;
  command->add_option("--title", plan.title, "what people read above it")->capture_default_str();
  command->add_option("--name", plan.name, "in addresses: a-z 0-9 _ -")->capture_default_str();
  command->add_option("--seats", plan.seats, "chairs at the table")->capture_default_str();
  command->add_option("--most", plan.most, "participants at once; more are told that it is full")
      ->capture_default_str();
  command->add_option("--port", plan.port, "of the page")->capture_default_str();
  command->add_option("--address", plan.address,
                      "where to listen [127.0.0.1: only this machine]; 0.0.0.0: for whoever can reach it");
  command->add_option("--host", plan.host, "this machine's name in the links");
  command->add_option("--mqtt-port", plan.broker.port, "for trackers [1883, with TLS 8883, or a free one]");
  command->add_option("--ws-port", plan.broker.web_port, "for browsers [9001, or a free one]");
  command->add_option("--certificate", plan.certificate, "PEM file: all is encrypted by TLS");
  command->add_option("--key", plan.key, "PEM file: the certificate's key");
  command->add_option(
      "--secrets", plan.secrets,
      "file that keeps the links for the next time [~/.local/state/telemime/rooms/NAME.json]");
  command->add_flag("--new-links", plan.new_links, "links that were shared before open nothing any more");
  command->add_option("--avatars", options->avatars, "folder of further avatars, LOOK.vrm");
  command->add_option("--mosquitto", plan.broker.program, "program of the broker Mosquitto");
  command->add_option("--seconds", options->seconds, "end after so many seconds [0: never]");
  command->add_flag("--quiet", options->quiet, "print only the links, warnings and errors");
  // What else can be done with rooms: one line each.
  add_room_record_command(*command);
  add_room_replay_command(*command);
  add_room_people_command(*command);
  command->callback([command, options] {
    if (command->get_subcommands().empty()) {
      run(*options);
    }
  });
}

}  // namespace telemime
