// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "meeting/protocol/messages.h"
#include "meeting/protocol/pose_frame.h"
#include "meeting/protocol/testing.h"
#include "meeting/transport/recorder.h"
#include "meeting/transport/replay.h"
#include "subscriber.h"
#include "telemime/streaming/testing_receivers.h"

namespace telemime::meeting::test_support {

inline const std::string kWatches = "topic read r/home/studio/#\n";
inline constexpr std::uint64_t kFrameTime = 33'333;  // us

/// Records until end().
class Recording {
 public:
  Recording(const std::string& where, const std::string& file)
      : login_(where, /*watch=*/true, "", {}),
        recorder_(
            login_, [this] { return stop_.load(); }, [this](const std::string& text) { report(text); }),
        writer_(new_recording_file(file), {recorder_.log_in().meeting, "today"}),
        thread_([this] { writer_.end(recorder_.record(writer_)); }) {}
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;
  ~Recording() { end(); }

  void end() {
    stop_ = true;
    if (thread_.joinable()) {
      thread_.join();
    }
  }
  bool has(std::uint64_t messages) const {
    return testing_receivers::comes_true([&] { return writer_.messages() >= messages; });
  }
  std::uint64_t messages() const { return writer_.messages(); }
  bool reported(const std::string& text) {
    return testing_receivers::comes_true([&] {
      const std::lock_guard lock(mutex_);
      return reports_.find(text) != std::string::npos;
    });
  }

 private:
  void report(const std::string& text) {
    const std::lock_guard lock(mutex_);
    reports_ += text + '\n';
  }
  std::atomic<bool> stop_ = false;
  std::mutex mutex_;
  std::string reports_;
  MeetingLogin login_;
  MeetingRecorder recorder_;
  RecordingWriter writer_;
  std::thread thread_;
};

inline std::vector<std::string> recorded(const std::string& file, const std::string& participant,
                                         TopicKind kind) {
  std::vector<std::string> payloads;
  for (const Record& record : records_of(file)) {
    const auto* const message = std::get_if<RecordedMessage>(&record);
    if (message != nullptr && message->topic.participant == participant && message->topic.kind == kind) {
      payloads.push_back(message->payload);
    }
  }
  return payloads;
}

/// Writes a recording of `count` participants q0, q1, ... with the names Q0, Q1, ..., who do not move.
inline std::string write_test_recording(const std::string& file, int count, int frames,
                                        std::size_t page = 0) {
  RecordingWriter writer(new_recording_file(file), {{"home", "studio"}, "today"});
  for (int who = 0; who < count; ++who) {
    const std::string name = "q" + std::to_string(who);
    ParticipantState state;
    state.session = 7;
    state.name = "Q" + std::to_string(who);
    writer.add(RecordedMessage{0, {TopicKind::presence, name, 0}, write_presence({true, 7})});
    writer.add(RecordedMessage{0, {TopicKind::state, name, 0}, write_state(state)});
    for (int n = 0; n < kMostBoardPages && page > 0; ++n) {
      const std::string strokes =
          R"({"v":1,"epoch":0,"strokes":[],"fill":")" + std::string(page, 'x') + "\"}";
      writer.add(RecordedMessage{0, {TopicKind::board, name, n}, strokes});
    }
  }
  for (int i = 0; i < frames; ++i) {
    for (int who = 0; who < count; ++who) {
      PoseFrame frame;
      frame.session = 7;
      frame.sequence = static_cast<std::uint32_t>(i);
      frame.captured = 1'000'000 + i * kFrameTime;
      writer.add(
          RecordedMessage{i * kFrameTime, {TopicKind::pose, "q" + std::to_string(who), 0}, bytes_of(frame)});
    }
  }
  writer.end(frames * kFrameTime);
  return file;
}

inline ReplayOptions replay_to(const std::string& meeting, const std::string& file,
                               const std::set<std::string>& only = {}) {
  ReplayOptions options;
  options.file = file;
  options.to = meeting;
  options.only = only;
  return options;
}

inline bool has_left(const Subscriber& subscriber, const std::string& participant) {
  return testing_receivers::comes_true([&] {
    const auto state = subscriber.newest("p/" + participant + "/state");
    const auto presence = subscriber.json("p/" + participant + "/presence");
    return state && state->payload.empty() && presence.is_object() && presence.at("here") == false;
  });
}

}  // namespace telemime::meeting::test_support
