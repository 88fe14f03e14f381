// SPDX-License-Identifier: Apache-2.0
#include "telemime/live/live_settings.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <fstream>
#include <nlohmann/json.hpp>
#include <system_error>

#include "telemime/core/errors.h"

namespace telemime {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::streamsize kLongestFile = 100'000;  // bytes
constexpr std::size_t kMostOutputs = 64;
constexpr int kVersion = 1;

[[noreturn]] void damaged(const fs::path& file, const std::string& what) {
  throw Error(ErrorKind::config, "the settings in " + file.string() + " cannot be used: " + what,
              "Correct or delete the file. When an output is added or removed on the page, a new file "
              "replaces it, and "
              "this one is renamed to end in \".old\".");
}

[[noreturn]] void unwritable(const fs::path& file, int error_number) {
  throw Error(ErrorKind::output,
              "the settings cannot be saved in " + file.string() + ": " +
                  std::generic_category().message(error_number),
              "The outputs of this run will not be listed in the next run.");
}

// A new file that is deleted unless it was written completely and moved.
class NewFile {
 public:
  explicit NewFile(const fs::path& path)
      : path_(path), descriptor_(::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600)) {}
  ~NewFile() {
    if (descriptor_ >= 0) {
      ::close(descriptor_);
    }
    if (!whole_) {
      ::unlink(path_.c_str());
    }
  }
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;

  bool write(const std::string& bytes) const {
    std::size_t done = 0;
    while (descriptor_ >= 0 && done < bytes.size()) {
      const ssize_t count = ::write(descriptor_, bytes.data() + done, bytes.size() - done);
      if (count < 0 && errno != EINTR) {
        return false;
      }
      done += count > 0 ? static_cast<std::size_t>(count) : 0;
    }
    return descriptor_ >= 0 && ::fsync(descriptor_) == 0;
  }
  bool move_to(const fs::path& file) {
    whole_ = ::rename(path_.c_str(), file.c_str()) == 0;
    return whole_;
  }

 private:
  fs::path path_;
  int descriptor_;
  bool whole_ = false;
};

// An exclusive lock on a folder; no effect on file systems without locks.
class FolderLock {
 public:
  explicit FolderLock(const fs::path& folder)
      : descriptor_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
    while (descriptor_ >= 0 && ::flock(descriptor_, LOCK_EX) != 0 && errno == EINTR) {
    }
  }
  ~FolderLock() {
    if (descriptor_ >= 0) {
      ::close(descriptor_);
    }
  }
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_;
};

// The target of a chain of symbolic links, which need not exist, so that writing does not replace the link.
fs::path at_end_of_links(fs::path file) {
  constexpr int kMostLinks = 40;
  std::error_code failed;
  for (int links = 0; links < kMostLinks && fs::is_symlink(file, failed); ++links) {
    file = file.parent_path() / fs::read_symlink(file, failed);
  }
  return file;
}

// A name for the backup of an unusable file.
fs::path free_name_beside(const fs::path& file) {
  constexpr int kMost = 9;  // after these the last one is overwritten
  fs::path name;
  std::error_code unknown;
  for (int number = 1; number <= kMost; ++number) {
    name = file;
    name += number == 1 ? ".old" : ".old-" + std::to_string(number);
    if (!fs::exists(name, unknown)) {
      break;
    }
  }
  return name;
}

// The content of the file; an empty object if it does not exist. Throws as load_settings().
Json read(const fs::path& file) {
  std::error_code failed;
  if (!fs::exists(file, failed) && !failed) {
    return Json::object();
  }
  std::ifstream in(file, std::ios::binary);
  std::string text(static_cast<std::size_t>(kLongestFile) + 1, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  if (in.bad() || (text.empty() && !in.eof())) {
    damaged(file, "it cannot be read");
  }
  if (text.size() > static_cast<std::size_t>(kLongestFile)) {
    damaged(file, "it is longer than " + std::to_string(kLongestFile) + " bytes");
  }
  // Limits the depth, because the parser is recursive.
  Json json = Json::parse(
      text, [](int depth, Json::parse_event_t, Json&) { return depth < 8; }, /*allow_exceptions=*/false);
  if (!json.is_object() || !json.contains("outputs") || !json["outputs"].is_array()) {
    damaged(file, "not a settings file of Telemime");
  }
  if (json.value("version", Json()) != kVersion) {
    damaged(file, "it was written by another version of Telemime");
  }
  const Json& urls = json["outputs"];
  if (urls.size() > kMostOutputs ||
      !std::all_of(urls.begin(), urls.end(), [](const Json& url) { return url.is_string(); })) {
    damaged(file, "invalid list of outputs");
  }
  return json;
}

LiveSettings settings_of(const Json& json) {
  return {json.value("outputs", std::vector<std::string>())};
}

}  // namespace

LiveSettings load_settings(const fs::path& file) {
  return settings_of(read(file));
}

void update_settings(const fs::path& file, const std::function<void(LiveSettings&)>& change) {
  std::error_code failed;
  const fs::path target = at_end_of_links(fs::absolute(file, failed));
  const fs::path folder = target.parent_path();
  if (fs::create_directories(folder, failed)) {
    fs::permissions(folder, fs::perms::owner_all, failed);
  }
  const FolderLock alone(folder);
  bool unusable = false;
  Json json;
  try {
    json = read(target);
  } catch (const Error&) {  // reported when it was loaded; kept as a backup
    unusable = fs::is_regular_file(target, failed);
    json = Json::object();
  }
  LiveSettings settings = settings_of(json);
  change(settings);
  std::vector<std::string>& urls = settings.outputs;
  if (urls.size() > kMostOutputs) {
    urls.erase(urls.begin(), urls.end() - static_cast<std::ptrdiff_t>(kMostOutputs));
  }
  json["version"] = kVersion;
  json["outputs"] = urls;
  fs::path next = target;
  next += ".new-" + std::to_string(::getpid());
  errno = 0;
  NewFile made(next);
  if (!made.write(json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n")) {
    unwritable(target, errno);
  }
  const fs::path aside = unusable ? free_name_beside(target) : fs::path();
  if (unusable) {
    fs::rename(target, aside, failed);
  }
  errno = 0;
  if (!made.move_to(target)) {
    const int reason = errno;
    if (unusable) {
      fs::rename(aside, target, failed);
    }
    unwritable(target, reason);
  }
}

void save_settings(const fs::path& file, const LiveSettings& settings) {
  update_settings(file, [&](LiveSettings& kept) { kept = settings; });
}

}  // namespace telemime
