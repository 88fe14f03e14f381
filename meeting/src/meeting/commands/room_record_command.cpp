// SPDX-License-Identifier: Apache-2.0
#include "meeting/commands/room_record_command.h"

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <chrono>
#include <ctime>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <memory>
#include <sstream>
#include <string>

#include "cli/interrupt.h"
#include "meeting/transport/room_recorder.h"
#include "telemime/core/errors.h"

namespace telemime {
namespace {

struct RecordArguments {
  std::string where;
  std::string out;
  std::string ca;
  double seconds = 0.0;
};

std::string date_now() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm parts{};
  ::gmtime_r(&now, &parts);
  std::ostringstream text;
  text << std::put_time(&parts, "%Y-%m-%dT%H:%M:%SZ");
  return text.str();
}

void run_record(const RecordArguments& arguments) {
  using Clock = std::chrono::steady_clock;
  note_interrupts();
  const auto start = Clock::now();
  const auto stop = [&] {
    const double passed = std::chrono::duration<double>(Clock::now() - start).count();
    return interrupted() || (arguments.seconds > 0.0 && passed >= arguments.seconds);
  };
  const auto say = [](const std::string& words) { std::cerr << words << std::endl; };
  RoomDoor door(arguments.where, /*watch=*/true, arguments.ca);
  RoomRecorder recorder(door, stop, say);
  const RoomLogin& login = recorder.come_in();
  if (!login.warning.empty()) {
    say(login.warning);
  }
  SessionWriter writer(new_session_file(arguments.out), {login.room, date_now()});
  std::cout << "recording " << door.shown() << " to " << arguments.out << "   Ctrl-C ends" << std::endl;
  std::uint64_t end = 0;
  try {
    end = recorder.record(writer);
  } catch (...) {
    if (writer.messages() == 0) {
      std::error_code ignored;
      std::filesystem::remove(arguments.out, ignored);  // so that the next try may make it
    }
    throw;
  }
  writer.end(end);
  constexpr double kMega = 1e6;
  std::cout << std::fixed << std::setprecision(1) << static_cast<double>(end) / kMega << " s, "
            << writer.messages() << " messages, " << static_cast<double>(writer.bytes()) / kMega << " MB";
  if (writer.dropped() > 0) {
    std::cout << "; " << writer.dropped() << " messages are missing: the disk was too slow";
  }
  std::cout << std::endl;
}

}  // namespace

void add_room_record_command(CLI::App& room) {
  const auto arguments = std::make_shared<RecordArguments>();
  CLI::App* const command =
      room.add_subcommand("record", "Record what everybody in a room does and says, to one file");
  command
      ->add_option("room", arguments->where,
                   "the room's link, or its broker: mqtt://user:password@host/tenant/room")
      ->required();
  command->add_option("--out", arguments->out, "the new file, NAME.troom")->required();
  command->add_option("--seconds", arguments->seconds, "end after so many seconds [0: never]")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--ca", arguments->ca, "certificates to trust with https and mqtts, a PEM file");
  command->callback([arguments] { run_record(*arguments); });
}

}  // namespace telemime
