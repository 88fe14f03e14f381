// SPDX-License-Identifier: Apache-2.0
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <chrono>
#include <ctime>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "cli/interrupt.h"
#include "meeting/commands/commands.h"
#include "meeting/transport/recorder.h"
#include "meeting/transport/replay.h"

namespace telemime::meeting {
namespace {

constexpr const char* kMeetingHelp =
    "Link of the meeting, or its broker: mqtt://user:password@host/tenant/room";
constexpr const char* kCaHelp = "PEM file of the certificates to trust with https and mqtts.";

void report(const std::string& text) {
  std::cerr << text << std::endl;
}

struct RecordArguments {
  std::string where;
  std::string out;
  std::string ca;
  double seconds = 0.0;
};

std::string utc_now() {
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
    const double elapsed = std::chrono::duration<double>(Clock::now() - start).count();
    return interrupted() || (arguments.seconds > 0.0 && elapsed >= arguments.seconds);
  };
  MeetingLogin login(arguments.where, /*watch=*/true, arguments.ca, stop);
  MeetingRecorder recorder(login, stop, report);
  const BrokerLogin& broker = recorder.log_in();
  if (!broker.warning.empty()) {
    report(broker.warning);
  }
  WriteBytes file = new_recording_file(arguments.out);
  std::optional<RecordingWriter> writing;
  std::uint64_t end = 0;
  try {
    writing.emplace(std::move(file), RecordingStart{broker.meeting, utc_now()});
    std::cout << "Recording " << login.shown() << " to " << arguments.out << " (press Ctrl-C to stop)"
              << std::endl;
    end = recorder.record(*writing);
  } catch (...) {
    if (!writing || writing->messages() == 0) {
      std::error_code ignored;
      std::filesystem::remove(arguments.out, ignored);  // so that the next attempt can create it
    }
    throw;
  }
  RecordingWriter& writer = *writing;
  writer.end(end);
  constexpr double kMega = 1e6;
  std::cout << std::fixed << std::setprecision(1) << static_cast<double>(end) / kMega << " s, "
            << writer.messages() << " messages, " << static_cast<double>(writer.bytes()) / kMega << " MB";
  if (writer.dropped() > 0) {
    std::cout << "; " << writer.dropped()
              << " messages are missing: the disk was too slow, or there were too many participants";
  }
  std::cout << std::endl;
}

struct ReplayArguments {
  ReplayOptions options;
  std::string file;
  std::string ca;
  std::vector<std::string> only;
};

void run_replay(ReplayArguments arguments) {
  note_interrupts();
  ReplayOptions& options = arguments.options;
  options.file = arguments.file;
  options.ca = arguments.ca;
  options.only = {arguments.only.begin(), arguments.only.end()};
  for (const ReplayedParticipant& person : replay_recording(options, interrupted, report)) {
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

void add_recording_commands(CLI::App& meeting) {
  const auto record = std::make_shared<RecordArguments>();
  CLI::App* command =
      meeting.add_subcommand("record", "Record the motion and messages of everyone to one file");
  command->add_option("meeting", record->where, kMeetingHelp)->required();
  command->add_option("--out", record->out, "New file, NAME.troom.")->required();
  command->add_option("--seconds", record->seconds, "Stop after this many seconds [0: never].")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--ca", record->ca, kCaHelp);
  command->callback([record] { run_record(*record); });

  const auto replay = std::make_shared<ReplayArguments>();
  command = meeting.add_subcommand("replay", "Replay a recording: everyone in it joins a meeting again");
  command->add_option("file", replay->file, "File written by telemime meeting record.")->required();
  command->add_option("--to", replay->options.to, kMeetingHelp)->required();
  command->add_option("--speed", replay->options.speed, "Playback speed [1].")
      ->check(CLI::Range(kSlowestReplay, kFastestReplay));
  command->add_flag("--loop", replay->options.loop, "Start again at the end, until Ctrl-C.");
  command->add_option("--only", replay->only, "Replay only this participant, by name; repeatable.");
  command->add_option("--ca", replay->ca, kCaHelp);
  command->callback([replay] { run_replay(*replay); });
}

}  // namespace telemime::meeting
