// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "telemime/live/live_state.h"
#include "telemime/outputs/all.h"

namespace telemime {

struct RecordedFile {
  std::string name;
  std::uintmax_t bytes = 0;
};

/// A finished recording, or the one in progress.
struct Recording {
  int number = 0;  ///< from 1, as in the name of its folder
  double seconds = 0.0;
  std::int64_t frames = 0;
  std::filesystem::path folder;
  std::vector<RecordedFile> files;  ///< of a finished recording
};

/// Two hours at 30 frames per second.
inline constexpr std::int64_t kMostRecordedFrames = 216'000;

/// Records live motion in every format, one folder per recording: with the frames and times of the tracker in
/// formats that have times, at a constant rate (resampler.h) in the others. After a
/// gap of more than 10 s it continues in a new recording. A separate thread writes: a slow disk
/// loses frames of the recording after 10 s but never delays the tracker; a full disk ends the recording,
/// whose files keep the frames written so far. Thread-safe; only the constructor throws.
class Recorder {
 public:
  using Message = std::function<void(MessageLevel, const std::string&)>;

  /// `folder` is created with the first recording. `message` receives messages for the user, from the
  /// recorder's thread. After `most_frames` frames a recording continues in a new one, because some formats
  /// hold their frames in memory until the end (all formats with hands and face: 1,600 bytes per frame, 142
  /// MB for an hour at 25 frames a second, and half as much again while the recording ends).
  Recorder(std::filesystem::path folder, OutputOptions options, Message message,
           std::int64_t most_frames = kMostRecordedFrames,
           std::span<const OutputFormat> formats = kOutputFormats);
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;
  ~Recorder();  ///< close()

  /// Ends the recording and completes its files. Afterwards nothing is recorded and no message is sent. Not
  /// thread-safe.
  void close();

  /// Sets the person of the following frames. A recording in progress ends and a new one begins, because a
  /// file describes one body.
  void person(const StreamHeader& header);
  void write(const MotionFrame& frame);

  void start();
  void stop();

  /// The recording in progress; its number is 0 until the first frame of a person.
  std::optional<Recording> current() const;
  std::vector<Recording> ended() const;
  /// The path of a file of a finished recording; nothing if there is no such file.
  std::optional<std::filesystem::path> file(int number, const std::string& name) const;
  /// Deletes the files of a finished recording asynchronously; false if there is no such recording.
  bool forget(int number);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace telemime
