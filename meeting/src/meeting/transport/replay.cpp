// SPDX-License-Identifier: Apache-2.0
#include "meeting/transport/replay.h"

#include <algorithm>
#include <chrono>
#include <map>
#include <thread>
#include <utility>

#include "meeting/protocol/meeting_info.h"
#include "meeting/protocol/recording_reader.h"
#include "telemime/core/errors.h"

namespace telemime::meeting {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using SteadyClock = std::chrono::steady_clock;

constexpr milliseconds kCheck{50};
constexpr std::chrono::seconds kLongestStart{20};    // until everyone is connected
constexpr std::chrono::seconds kLongestEnd{2};       // until everything is published
constexpr std::chrono::seconds kShortestPass{5};     // with loop
constexpr double kLongestSession = 365.0 * 86400e6;  // us
constexpr milliseconds kLead{100};  // before the first message of a pass, so that none is late

using Stop = std::function<bool()>;

struct Part {
  std::string recorded;
  std::set<std::string> names;
  std::unique_ptr<MeetingLogin> login;
  std::unique_ptr<ReplayParticipant> replayer;
  std::uint16_t session = 0;  ///< the first of this pass
};

/// Waits until `done` returns true, or until `end`. Returns false when it was stopped.
template <class Done>
bool wait_until(SteadyClock::time_point end, const Stop& stop, const Done& done) {
  for (;;) {
    if (stop()) {
      return false;
    }
    const auto now = SteadyClock::now();
    if (done() || now >= end) {
      return true;
    }
    std::this_thread::sleep_until(std::min(end, now + kCheck));
  }
}

std::string names_in(const RecordingSummary& summary) {
  std::string list;
  for (const auto& [participant, person] : summary.people) {
    if (person.takes_part) {
      list += (list.empty() ? "" : ", ") + participant;
      for (const std::string& name : person.names) {
        list += " \"" + name + "\"";
      }
    }
  }
  return list;
}

std::vector<Part> parts_of(const RecordingSummary& summary, const ReplayOptions& options) {
  std::vector<Part> parts;
  for (const auto& [participant, person] : summary.people) {
    if (person.takes_part && is_wanted(participant, person, options.only)) {
      parts.push_back({participant, person.names, nullptr, nullptr, random_session()});
    }
  }
  for (const std::string& wanted : options.only) {
    const bool found = std::any_of(summary.people.begin(), summary.people.end(), [&](const auto& entry) {
      return entry.second.takes_part && is_wanted(entry.first, entry.second, {wanted});
    });
    if (!found) {
      throw Error(ErrorKind::usage, "\"" + wanted + "\" is not in the recording",
                  "It contains: " + names_in(summary));
    }
  }
  if (parts.empty()) {
    throw Error(ErrorKind::input, options.file.string() + " contains nobody to replay");
  }
  if (parts.size() > kMostReplayed) {
    throw Error(ErrorKind::usage, std::to_string(parts.size()) + " participants are too many for a replay",
                "Choose up to " + std::to_string(kMostReplayed) + " of them with --only.");
  }
  return parts;
}

// By a link everyone gets a seat of their own; the account of a broker publishes for all, under their old
// ids.
BrokerLogin login_of(Part& part, const ReplayOptions& options, const Stop& stop) {
  part.login = std::make_unique<MeetingLogin>(options.to, /*watch=*/false, options.ca, stop, options.log_in);
  BrokerLogin login = part.login->log_in();
  if (!part.login->is_link()) {
    login.participant = part.recorded;
  } else if (login.participant.empty()) {
    throw Error(ErrorKind::input, "the link at " + part.login->shown() + " only allows watching",
                "A replay needs a link to speak.");
  }
  return login;
}

bool all_ready(const std::vector<Part>& parts) {
  for (const Part& part : parts) {
    const ReplayParticipant::Status status = part.replayer->status();
    if (!status.failure.empty()) {
      const bool forbidden = !part.login->is_link() && status.failure.find("account") != std::string::npos;
      throw Error(
          ErrorKind::input,
          "\"" + part.recorded + "\" cannot take part at " + part.login->shown() + ": " + status.failure,
          forbidden
              ? "A replay to the URL of a broker needs an account that may publish for all participants. The "
                "link of a meeting gives everyone an account of their own."
              : "");
    }
    if (!status.ready) {
      return false;
    }
  }
  return true;
}

/// One time through the recording.
class Pass {
 public:
  Pass(std::vector<Part>& parts, const ReplayOptions& options, const Stop& stop)
      : speed_(options.speed), stop_(stop), start_(SteadyClock::now() + kLead), reader_(options.file) {
    const auto clock = std::chrono::duration_cast<microseconds>(start_.time_since_epoch());
    for (Part& part : parts) {
      people_.emplace(
          part.recorded,
          Person{&part, ParticipantReplay(speed_, part.session, static_cast<std::uint64_t>(clock.count()))});
    }
  }

  /// Returns false when it was stopped.
  bool run() {
    while (const auto record = reader_.next()) {
      const std::chrono::duration<double, std::micro> passed(
          std::min(static_cast<double>(time_of(*record)) / speed_, kLongestSession));
      const auto due = start_ + std::chrono::duration_cast<SteadyClock::duration>(passed);
      if (!wait_until(due, stop_, [] { return false; })) {
        return false;
      }
      if (const auto* const message = std::get_if<RecordedMessage>(&*record)) {
        publish(*message);
      }
    }
    for (auto& [recorded, person] : people_) {
      person.part->session = static_cast<std::uint16_t>(person.replay.session() % UINT16_MAX + 1);
    }
    return true;
  }

 private:
  struct Person {
    Part* part;
    ParticipantReplay replay;
  };

  void publish(const RecordedMessage& message) {
    if (message.topic.kind == TopicKind::meeting) {
      if (const auto epoch = read_epoch(message.payload)) {
        for (auto& [recorded, person] : people_) {
          person.replay.set_epoch(*epoch);
        }
      }
      return;
    }
    const auto found = people_.find(message.topic.participant);
    if (found != people_.end()) {
      if (auto step = found->second.replay.step(message)) {
        found->second.part->replayer->publish(std::move(*step));
      }
    }
  }

  const double speed_;
  const Stop& stop_;
  const SteadyClock::time_point start_;
  RecordingReader reader_;
  std::map<std::string, Person> people_;
};

void finish_publishing(const std::vector<Part>& parts, const Stop& stop) {
  wait_until(SteadyClock::now() + kLongestEnd, stop, [&] {
    return std::all_of(parts.begin(), parts.end(), [](const Part& part) { return part.replayer->idle(); });
  });
}

}  // namespace

std::vector<ReplayedParticipant> replay_recording(
    const ReplayOptions& options, const Stop& stop,
    const std::function<void(const std::string& text)>& report) {
  const RecordingReport recording = inspect_recording(options.file);
  if (!recording.complaint.empty()) {
    report(options.file.string() + ": " + recording.complaint);
  }
  std::vector<Part> parts = parts_of(recording.summary, options);
  for (Part& part : parts) {
    part.replayer = std::make_unique<ReplayParticipant>(login_of(part, options, stop), part.session);
  }
  bool ready = false;
  const bool go_on =
      wait_until(SteadyClock::now() + kLongestStart, stop, [&] { return ready = ready || all_ready(parts); });
  if (go_on && !ready) {
    throw Error(ErrorKind::input, "not everyone could join within 20 s: the broker does not answer");
  }
  if (go_on) {
    report("replaying " + std::to_string(parts.size()) +
           (parts.size() == 1 ? " participant" : " participants"));
    auto begun = SteadyClock::now();
    while (Pass(parts, options, stop).run() && options.loop) {
      // A limit for how often everyone in the meeting sees them leave and join.
      wait_until(begun + kShortestPass, stop, [] { return false; });
      begun = SteadyClock::now();
      for (const Part& part : parts) {
        part.replayer->leave();
      }
      finish_publishing(parts, stop);
    }
    finish_publishing(parts, stop);
  }
  std::vector<ReplayedParticipant> people;
  people.reserve(parts.size());
  for (const Part& part : parts) {
    people.push_back({part.recorded, part.replayer->participant(), part.names, part.replayer->status()});
  }
  return people;
}

}  // namespace telemime::meeting
