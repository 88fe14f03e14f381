// SPDX-License-Identifier: Apache-2.0
#include "telemime/live/recorder.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>

#include "telemime/core/errors.h"
#include "telemime/core/heap.h"
#include "telemime/offline/motion_files.h"
#include "telemime/offline/resampler.h"

namespace telemime {
namespace {

constexpr std::size_t kMostWaiting = 250;  // frames
constexpr double kLongestBridge = 10.0;    // s; a recording ends at a longer gap

// A task for the recorder's thread.
struct Task {
  enum class Kind { person, frame, start, stop, forget } kind = Kind::frame;
  std::shared_ptr<const StreamHeader> header = {};
  MotionFrame frame = {};
  Recording recording = {};
};

// The recording that is being written.
struct Open {
  Recording recording;
  Resampler resampler;
  MotionFiles files;
  std::int64_t last = -1;  // number of the last frame
};

}  // namespace

struct Recorder::State {
  void push(Task task) {
    {
      const std::lock_guard lock(mutex);
      if (task.kind == Task::Kind::frame && tasks.size() >= kMostWaiting) {
        ++lost;
        return;
      }
      tasks.push_back(std::move(task));
    }
    changed.notify_all();
  }

  void work() {
    while (true) {
      Task task;
      {
        std::unique_lock lock(mutex);
        changed.wait(lock, [this] { return stop || !tasks.empty(); });
        if (tasks.empty()) {
          break;
        }
        task = std::move(tasks.front());
        tasks.pop_front();
      }
      try {
        carry_out(task);
      } catch (const std::exception& e) {
        // For instance a full disk: the frames written so far are kept.
        asked = false;
        wanted = false;
        say(MessageLevel::error, std::string("the recording was stopped: ") + e.what());
        close();
      }
    }
    close();
  }

  void carry_out(const Task& task) {
    switch (task.kind) {
      case Task::Kind::person:
        header = task.header;
        if (open) {
          say(MessageLevel::info, "recalibrated: recording " + std::to_string(open->recording.number) +
                                      " ends here and continues in the next one");
        }
        close();
        break;
      case Task::Kind::start:
        wanted = true;
        if (!header) {
          say(MessageLevel::info, "the recording starts when a person is tracked");
        }
        break;
      case Task::Kind::stop:
        wanted = false;
        close();
        break;
      case Task::Kind::frame:
        if (wanted && header) {
          write(task.frame);
        }
        break;
      case Task::Kind::forget:
        remove(task.recording);
        break;
    }
  }

  void write(const MotionFrame& frame) {
    if (open && open->resampler.gap_before(frame) > kLongestBridge) {
      const auto gap = std::lround(open->resampler.gap_before(frame));
      say(MessageLevel::warning, "no frames for " + std::to_string(gap) + " s: recording " +
                                     std::to_string(open->recording.number) +
                                     " ends here and continues in the next one");
      close();
    }
    if (!open) {
      begin();
    }
    // Whoever is lost at the end of the input is so in a frame that was written already.
    if (frame.frame > open->last) {
      open->last = frame.frame;
      open->files.write(frame, true);
    }
    open->resampler.push(frame, [this](const MotionFrame& made) {
      open->files.write(made, false);
      const std::lock_guard lock(mutex);
      open->recording.frames = made.frame + 1;
      open->recording.seconds = static_cast<double>(made.frame + 1) / header->fps;
    });
    {
      const std::lock_guard lock(mutex);
      current = open->recording;
    }
    if (open->recording.frames >= most_frames) {
      say(MessageLevel::info,
          "recording " + std::to_string(open->recording.number) + " is full and continues in the next one");
      close();
    }
  }

  void begin() {
    Recording recording;
    std::error_code failed;
    std::error_code unknown;
    std::filesystem::create_directories(folder, failed);
    do {  // never reuses a folder of an earlier or concurrent run
      recording.number = next_number++;
      recording.folder = folder / ("recording-" + std::to_string(recording.number));
    } while (!std::filesystem::create_directory(recording.folder, failed) &&
             std::filesystem::exists(recording.folder, unknown));
    if (failed) {
      throw Error(ErrorKind::output,
                  "the folder " + recording.folder.string() + " cannot be created: " + failed.message(),
                  "Choose another one with --recordings.");
    }
    Open made{recording, Resampler(header->body, header->camera, header->fps), {}};
    for (const OutputFormat& format : formats) {
      made.files.open(recording.folder, format, options, *header);
    }
    open.emplace(std::move(made));
  }

  void close() {
    if (open) {
      end();
      give_heap_back();  // of the files' frames and the queue
    }
  }

  void end() {
    Open last = std::move(*open);
    open.reset();  // the recording is over, whatever fails from here on
    Recording recording = last.recording;
    std::int64_t missing = 0;
    {
      const std::lock_guard lock(mutex);
      missing = std::exchange(lost, 0);  // later losses count for the next recording
    }
    for (MotionFiles::File& file : last.files.all) {
      const std::filesystem::path path = file.output->path();
      try {
        file.output->close();
      } catch (const Error& e) {
        say(MessageLevel::error, e.what());
      } catch (const std::exception& e) {  // out of memory: the others may need less
        say(MessageLevel::error, path.string() + " is incomplete: " + e.what());
      }
      file.output.reset();  // frees its frames: the next file needs memory to end
      std::error_code failed;
      const auto bytes = std::filesystem::file_size(path, failed);
      if (!failed) {
        recording.files.push_back({path.filename().string(), bytes});
      }
    }
    {
      const std::lock_guard lock(mutex);
      current.reset();
      ended.push_back(recording);
    }
    say(MessageLevel::info,
        "recorded " + std::to_string(recording.frames) + " frames in " + recording.folder.string());
    if (missing > 0) {
      say(MessageLevel::warning,
          std::to_string(missing) + " frames are missing in this recording: the disk was too slow");
    }
  }

  void remove(const Recording& recording) const {
    std::error_code failed;
    for (const RecordedFile& file : recording.files) {
      std::error_code why;
      if (!std::filesystem::remove(recording.folder / file.name, why) && why) {
        failed = why;
      }
    }
    if (failed) {
      say(MessageLevel::error,
          "the recording in " + recording.folder.string() + " could not be deleted: " + failed.message());
      return;
    }
    std::filesystem::remove(recording.folder, failed);  // fails if it contains other files
  }

  void say(MessageLevel level, const std::string& words) const {
    if (message) {
      message(level, words);
    }
  }

  std::filesystem::path folder;
  OutputOptions options;
  Message message;
  std::int64_t most_frames = 0;
  std::span<const OutputFormat> formats;

  // Used by the recorder's thread only.
  std::shared_ptr<const StreamHeader> header;
  std::optional<Open> open;
  bool wanted = false;
  int next_number = 1;

  std::atomic<bool> asked = false;  // frames are recorded

  mutable std::mutex mutex;  // guards the members below
  std::condition_variable changed;
  std::deque<Task> tasks;
  bool stop = false;
  std::int64_t lost = 0;
  std::optional<Recording> current;
  std::vector<Recording> ended;

  std::thread thread;
};

Recorder::Recorder(std::filesystem::path folder, OutputOptions options, Message message,
                   std::int64_t most_frames, std::span<const OutputFormat> formats)
    : state_(std::make_unique<State>()) {
  state_->folder = std::move(folder);
  state_->options = std::move(options);
  state_->message = std::move(message);
  state_->most_frames = most_frames;
  state_->formats = formats;
  state_->thread = std::thread([s = state_.get()] { s->work(); });
}

Recorder::~Recorder() {
  close();
}

void Recorder::close() {
  {
    const std::lock_guard lock(state_->mutex);
    state_->stop = true;
  }
  state_->changed.notify_all();
  if (state_->thread.joinable()) {
    state_->thread.join();
  }
}

void Recorder::person(const StreamHeader& header) {
  auto own = std::make_shared<StreamHeader>(header);
  own->fingers = header.fingers && state_->options.fingers;
  state_->push({Task::Kind::person, std::move(own)});
}

void Recorder::write(const MotionFrame& frame) {
  if (state_->asked) {
    state_->push({Task::Kind::frame, {}, frame});
  }
}

void Recorder::start() {
  state_->push({Task::Kind::start});
  state_->asked = true;
}

void Recorder::stop() {
  state_->asked = false;
  state_->push({Task::Kind::stop});
}

std::optional<Recording> Recorder::current() const {
  const std::lock_guard lock(state_->mutex);
  return !state_->current && state_->asked ? std::optional(Recording()) : state_->current;
}

std::vector<Recording> Recorder::ended() const {
  const std::lock_guard lock(state_->mutex);
  return state_->ended;
}

std::optional<std::filesystem::path> Recorder::file(int number, const std::string& name) const {
  for (const Recording& recording : ended()) {
    for (const RecordedFile& file : recording.files) {
      if (recording.number == number && file.name == name) {
        return recording.folder / name;
      }
    }
  }
  return std::nullopt;
}

bool Recorder::forget(int number) {
  std::unique_lock lock(state_->mutex);
  const auto found = std::find_if(state_->ended.begin(), state_->ended.end(),
                                  [number](const Recording& r) { return r.number == number; });
  if (found == state_->ended.end()) {
    return false;
  }
  Task task{Task::Kind::forget};
  task.recording = std::move(*found);
  state_->ended.erase(found);
  lock.unlock();
  state_->push(std::move(task));  // asynchronous, because the disk may be slow
  return true;
}

}  // namespace telemime
