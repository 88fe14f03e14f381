// SPDX-License-Identifier: Apache-2.0
#include "meeting/protocol/recording_writer.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <memory>
#include <system_error>
#include <utility>

#include "telemime/core/files.h"

namespace telemime::meeting {
namespace {

using SteadyClock = std::chrono::steady_clock;

constexpr std::chrono::seconds kToDisk{10};
constexpr std::size_t kRecordBytes = 128;  // approximate size of a record in memory, without its payload

/// A new file to append to.
class NewFile {
 public:
  explicit NewFile(std::filesystem::path file)
      : file_(std::move(file)),
        descriptor_(::open(file_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, S_IRUSR | S_IWUSR)) {
    if (descriptor_ < 0) {
      const int error = errno;
      throw Error(ErrorKind::output, file_.string() + " cannot be created: " + system_text(error),
                  error == EEXIST ? "A recording does not overwrite a file: choose another name." : "");
    }
  }
  ~NewFile() {
    ::fdatasync(descriptor_);
    ::close(descriptor_);
  }
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;

  void append(std::string_view bytes) {
    if (const int error = write_all(descriptor_, bytes); error != 0) {
      undo();
      fail(error);
    }
    size_ += static_cast<off_t>(bytes.size());
    synced_ = synced_ && bytes.empty();
    if (bytes.empty() || SteadyClock::now() - on_disk_ > kToDisk) {
      sync();
    }
  }

 private:
  static std::string system_text(int error) { return std::generic_category().message(error); }
  [[noreturn]] void fail(int error) const {
    throw Error(ErrorKind::output, file_.string() + " cannot be written: " + system_text(error),
                "The recording so far is usable.");
  }
  void sync() {
    // Some disks (over a network, or with a quota) report only now that they are full. EINVAL: the file
    // cannot be synchronised.
    if (!synced_ && ::fdatasync(descriptor_) != 0 && errno != EINVAL) {
      fail(errno);
    }
    synced_ = true;
    on_disk_ = SteadyClock::now();
  }
  // If this fails, readers ignore the incomplete record.
  void undo() const {
    if (::ftruncate(descriptor_, size_) != 0) {
      return;
    }
  }

  std::filesystem::path file_;
  int descriptor_;
  off_t size_ = 0;  ///< of the complete appends
  bool synced_ = true;
  SteadyClock::time_point on_disk_ = SteadyClock::now();
};

std::size_t size_of(const Record& record) {
  const auto* const message = std::get_if<RecordedMessage>(&record);
  return kRecordBytes + (message == nullptr ? 0 : message->payload.size());
}

bool is_pose(const Record& record) {
  const auto* const message = std::get_if<RecordedMessage>(&record);
  return message != nullptr && message->topic.kind == TopicKind::pose;
}

}  // namespace

WriteBytes new_recording_file(const std::filesystem::path& file) {
  return [open = std::make_shared<NewFile>(file)](std::string_view bytes) { open->append(bytes); };
}

RecordingWriter::RecordingWriter(WriteBytes write, const RecordingStart& start) : write_(std::move(write)) {
  const std::string begin = RecordingEncoder::begin(start);
  write_(begin);
  bytes_ = begin.size();
  thread_ = std::thread([this] { run(); });
}

RecordingWriter::~RecordingWriter() {
  finish();
}

void RecordingWriter::finish() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }
  changed_.notify_one();
  if (thread_.joinable()) {
    thread_.join();
  }
}

void RecordingWriter::add(Record record) {
  {
    const std::lock_guard lock(mutex_);
    const bool is_message = std::holds_alternative<RecordedMessage>(record);
    const std::size_t most = is_pose(record) ? kWriterQueueBytes / 2 : kWriterQueueBytes;
    if (failure_ || (is_message && waiting_ + size_of(record) > most)) {
      dropped_ += is_message ? 1 : 0;
      missing_ += is_message ? 1 : 0;
      return;
    }
    if (missing_ > 0) {
      queue_.emplace_back(MessagesDropped{time_of(record), std::exchange(missing_, 0)});
      waiting_ += kRecordBytes;
    }
    messages_ += is_message ? 1 : 0;
    waiting_ += size_of(record);
    queue_.push_back(std::move(record));
  }
  changed_.notify_one();
}

void RecordingWriter::end(std::uint64_t at) {
  add(RecordingEnd{at});
  finish();
  if (const auto text = failure()) {
    throw Error(ErrorKind::output, *text);
  }
  write_({});
  write_ = nullptr;  // closes the file
}

std::string RecordingWriter::encoded(std::deque<Record>& records) {
  std::string bytes;
  for (const Record& record : records) {
    if (const auto more = encoder_.encode(record)) {
      bytes += *more;
    } else {  // too many participants
      const std::lock_guard lock(mutex_);
      ++dropped_;
      ++missing_;
      --messages_;
    }
  }
  return bytes;
}

void RecordingWriter::run() {
  SteadyClock::time_point wrote = SteadyClock::now();
  std::unique_lock lock(mutex_);
  for (;;) {
    // After a pause the data so far is synchronised with the disk.
    changed_.wait_for(lock, kToDisk, [this] { return closed_ || !queue_.empty(); });
    if (closed_ && queue_.empty()) {
      return;
    }
    std::deque<Record> records = std::exchange(queue_, {});
    const std::size_t size = waiting_;
    lock.unlock();
    std::string written;
    std::optional<std::string> failure;
    try {
      written = encoded(records);
      // An empty string synchronises.
      if (!written.empty() || records.empty() || SteadyClock::now() - wrote > kToDisk) {
        write_(written);
        wrote = SteadyClock::now();
      }
    } catch (const std::exception& e) {
      failure = e.what();
    }
    records.clear();
    lock.lock();
    waiting_ -= size;
    if (failure) {
      failure_ = failure;
      queue_.clear();
      return;
    }
    bytes_ += written.size();
  }
}

std::optional<std::string> RecordingWriter::failure() const {
  const std::lock_guard lock(mutex_);
  return failure_;
}

std::uint64_t RecordingWriter::bytes() const {
  const std::lock_guard lock(mutex_);
  return bytes_;
}

std::uint64_t RecordingWriter::messages() const {
  const std::lock_guard lock(mutex_);
  return messages_;
}

std::uint64_t RecordingWriter::dropped() const {
  const std::lock_guard lock(mutex_);
  return dropped_;
}

}  // namespace telemime::meeting
