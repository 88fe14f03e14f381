// SPDX-License-Identifier: Apache-2.0
#include "meeting/commands/room_replay_command.h"

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "cli/interrupt.h"
#include "meeting/transport/room_replay.h"

namespace telemime {
namespace {

struct ReplayArguments {
  ReplayOptions options;
  std::string file;
  std::string ca;
  std::vector<std::string> only;
};

constexpr double kSlowest = 0.1;
constexpr double kFastest = 100.0;

void run_replay(ReplayArguments arguments) {
  note_interrupts();
  ReplayOptions& options = arguments.options;
  options.file = arguments.file;
  options.ca = arguments.ca;
  options.only = {arguments.only.begin(), arguments.only.end()};
  const auto people =
      replay_session(options, interrupted, [](const std::string& words) { std::cerr << words << std::endl; });
  for (const ReplayedPerson& person : people) {
    std::cout << person.recorded;
    for (const std::string& name : person.names) {
      std::cout << " \"" << name << '"';
    }
    std::cout << " as " << person.participant << ": " << person.status.frames << " frames sent, "
              << person.status.dropped << " dropped"
              << (person.status.failure.empty() ? "" : "; " + person.status.failure) << '\n';
  }
}

}  // namespace

void add_room_replay_command(CLI::App& room) {
  const auto arguments = std::make_shared<ReplayArguments>();
  CLI::App* const command =
      room.add_subcommand("replay", "Play a recording into a room: everybody in it comes in again");
  command->add_option("file", arguments->file, "what telemime room record wrote")->required();
  command
      ->add_option("--to", arguments->options.to,
                   "the room's link, or its broker: mqtt://user:password@host/tenant/room")
      ->required();
  command->add_option("--speed", arguments->options.speed, "how much faster than it was [1]")
      ->check(CLI::Range(kSlowest, kFastest));
  command->add_flag("--loop", arguments->options.loop, "begin again at the end, until Ctrl-C");
  command->add_option("--only", arguments->only,
                      "only this participant, by name; may be given several times");
  command->add_option("--ca", arguments->ca, "certificates to trust with https and mqtts, a PEM file");
  command->callback([arguments] { run_replay(*arguments); });
}

}  // namespace telemime
