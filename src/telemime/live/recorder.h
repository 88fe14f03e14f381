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

#include "telemime/live/message_level.h"
#include "telemime/outputs/all.h"

namespace telemime {

struct RecordedFile {
  std::string name;
  std::uintmax_t bytes = 0;
};

/// A recording that has ended, or the one that goes on.
struct Recording {
  int number = 0;  ///< from 1
  double seconds = 0.0;
  std::int64_t frames = 0;
  std::filesystem::path folder;
  std::vector<RecordedFile> files;  ///< of an ended one
};

/// Two hours at 30 frames a second.
inline constexpr std::int64_t kMostRecordedFrames = 216'000;

/// Records live motion into files, one folder for each recording, in every format and at a constant rate
/// (resampler.h). After a gap of more than kLongestBridge it goes on in the next recording. Writes in a
/// thread of its own: a slow disk costs frames of the recording, after 10 s, and never the tracker's time; a
/// full one ends the recording, whose files then hold what was written. Everything from any thread; nothing
/// throws but the constructor.
class Recorder {
 public:
  using Message = std::function<void(MessageLevel, const std::string&)>;

  /// `folder` is made with the first recording. `message` gets what the user should know, from the recorder's
  /// thread. A recording of `most_frames` goes on in the next one: some formats keep 230 bytes a frame in
  /// memory until its end (measured with all: 62 MB for an hour at 25 a second, twice that while it ends).
  Recorder(std::filesystem::path folder, OutputOptions options, Message message,
           std::int64_t most_frames = kMostRecordedFrames,
           std::span<const OutputFormat> formats = kOutputFormats);
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;
  ~Recorder();  ///< close()

  /// Ends the recording and writes its files to the end; nothing is recorded and no message comes any more.
  /// Not from several threads at once.
  void close();

  /// The person whose frames follow. A recording that goes on is ended and another one begun: a file is of
  /// one body.
  void person(const StreamHeader& header);
  void write(const MotionFrame& frame);

  void start();
  void stop();

  /// With number 0 while one was started and waits for a person's first frame.
  std::optional<Recording> current() const;
  std::vector<Recording> ended() const;
  /// Of an ended recording; nothing where there is no such file.
  std::optional<std::filesystem::path> file(int number, const std::string& name) const;
  /// Deletes an ended recording's files, soon; false when there is none of that number.
  bool forget(int number);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace telemime
