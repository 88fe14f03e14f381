// SPDX-License-Identifier: Apache-2.0
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <memory>
#include <numbers>
#include <string>
#include <thread>
#include <vector>

#include "cli/interrupt.h"
#include "meeting/commands/commands.h"
#include "meeting/transport/senders.h"
#include "telemime/core/errors.h"

namespace telemime::meeting {
namespace {

using Clock = std::chrono::steady_clock;

struct PeopleArguments {
  std::vector<std::string> outputs;
  double rate = 30.0;
  double seconds = 0.0;
};

/// One frame of a person who swings both arms and never rests. `time`, `phase`: s; people differ in phase.
MotionFrame frame_at(const StreamHeader& header, std::int64_t index, double time, double phase) {
  constexpr double kPeriod = 4.0;  // s
  const double turn = 2.0 * std::numbers::pi * (time + phase) / kPeriod;
  MotionFrame frame;
  frame.frame = index;
  frame.time = time;
  frame.state = TrackState::tracking;
  frame.pose.root = {0.05 * std::sin(turn), 0.45, 1.3};
  frame.pose[Angle::l_shoulder_flexion] = -0.6 + 0.5 * std::sin(turn);
  frame.pose[Angle::r_shoulder_flexion] = -0.6 - 0.5 * std::cos(turn);
  frame.pose[Angle::l_shoulder_abduct] = 0.5;
  frame.pose[Angle::r_shoulder_abduct] = -0.5;
  frame.pose[Angle::l_elbow_flexion] = -1.0 + 0.4 * std::sin(turn);
  frame.pose[Angle::r_elbow_flexion] = -1.0 - 0.4 * std::cos(turn);
  frame.joints = forward_kinematics(header.body, frame.pose).joints;
  for (std::size_t joint = 0; joint < kJointCount; ++joint) {
    frame.pixels[joint] = header.camera.project(frame.joints.at[joint]);
  }
  return frame;
}

StreamHeader synthetic_header() {
  StreamHeader header;
  header.body = make_body(Shape{});
  header.limits = anatomical_limits();
  return header;
}

// Waits until every sender is connected: the first frame of each sets the phase of its later ones
// (PublishPace), so a frame that waited for its connection would delay all the others.
void wait_until_connected(const std::vector<std::unique_ptr<Sender>>& senders) {
  constexpr std::chrono::seconds kLongest{20};
  constexpr std::chrono::milliseconds kLook{20};
  const auto end = Clock::now() + kLongest;
  for (const auto& sender : senders) {
    while (sender->status().state != SenderState::sending && !interrupted()) {
      if (Clock::now() > end) {
        throw Error(ErrorKind::output, sender->status().url + ": " + sender->status().words);
      }
      std::this_thread::sleep_for(kLook);
    }
  }
}

void run_people(const PeopleArguments& arguments) {
  note_interrupts();
  const StreamHeader header = synthetic_header();
  std::vector<std::unique_ptr<Sender>> senders;
  for (const std::string& output : arguments.outputs) {
    senders.push_back(make_sender(output, kAllSenderKinds));
    senders.back()->begin(header);
  }
  wait_until_connected(senders);
  std::cout << senders.size() << " people take part (press Ctrl-C to stop)" << std::endl;
  const auto start = Clock::now();
  const auto finished = [&](double time) {
    return interrupted() || (arguments.seconds > 0.0 && time >= arguments.seconds);
  };
  // The people send in turn, evenly spread over the frame time, like independent cameras.
  const auto count = static_cast<std::int64_t>(senders.size());
  for (std::int64_t turn = 0;; ++turn) {
    const double time = static_cast<double>(turn) / (arguments.rate * static_cast<double>(count));
    if (finished(time)) {
      break;
    }
    std::this_thread::sleep_until(
        start + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(time)));
    const auto who = static_cast<std::size_t>(turn % count);
    const MotionFrame frame = frame_at(header, turn / count, time, static_cast<double>(who));
    const std::chrono::duration<double, std::milli> now = Clock::now().time_since_epoch();
    senders[who]->send(frame, now.count());
  }
  for (const auto& sender : senders) {
    const SenderStatus status = sender->status();
    std::cout << status.url << ": " << status.sent << " frames sent, " << status.dropped << " dropped"
              << (status.words.empty() ? "" : "; " + status.words) << '\n';
  }
}

}  // namespace

void add_people_command(CLI::App& meeting) {
  const auto arguments = std::make_shared<PeopleArguments>();
  CLI::App* const command =
      meeting.add_subcommand("people", "Synthetic participants that send motion as trackers do, for tests");
  command
      ->add_option(
          "outputs", arguments->outputs,
          "One URL each, as for telemime live --send: mqtt://user:password@host/tenant/room?name=Ana")
      ->required();
  command->add_option("--rate", arguments->rate, "Frames per second of each [30].")
      ->check(CLI::Range(1.0, 120.0));
  command->add_option("--seconds", arguments->seconds, "Stop after this many seconds [0: never].")
      ->check(CLI::NonNegativeNumber);
  command->callback([arguments] { run_people(*arguments); });
}

}  // namespace telemime::meeting
