// SPDX-License-Identifier: Apache-2.0
#include "telemime/live/live_settings.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

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
              "Mend or delete the file; it is written anew when an output is added or removed on the page.");
}

[[noreturn]] void unwritable(const fs::path& file, int error_number) {
  throw Error(ErrorKind::output,
              "the settings cannot be kept in " + file.string() + ": " +
                  std::generic_category().message(error_number),
              "The outputs of this run are not known to the next one.");
}

// Closes; what was not written to the end is deleted.
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

}  // namespace

LiveSettings load_settings(const fs::path& file) {
  std::error_code failed;
  if (!fs::exists(file, failed) && !failed) {
    return {};
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
  // Brackets that go deeper than ours could fill the stack of the parser.
  const Json json = Json::parse(
      text, [](int depth, Json::parse_event_t, Json&) { return depth < 8; }, /*allow_exceptions=*/false);
  if (!json.is_object() || !json.contains("outputs") || !json["outputs"].is_array()) {
    damaged(file, "it is not what Telemime writes");
  }
  if (json.value("version", Json()) != kVersion) {
    damaged(file, "it was written by another version of Telemime");
  }
  LiveSettings settings;
  for (const Json& url : json["outputs"]) {
    if (!url.is_string() || settings.outputs.size() == kMostOutputs) {
      damaged(file, "its list of outputs is not what Telemime writes");
    }
    settings.outputs.push_back(url.get<std::string>());
  }
  return settings;
}

void save_settings(const fs::path& file, const LiveSettings& settings) {
  std::error_code failed;
  const fs::path folder = fs::absolute(file, failed).parent_path();
  if (fs::create_directories(folder, failed)) {
    fs::permissions(folder, fs::perms::owner_all, failed);
  }
  const Json json = {{"version", kVersion}, {"outputs", settings.outputs}};
  fs::path next = file;
  next += ".new-" + std::to_string(::getpid());
  errno = 0;
  NewFile made(next);
  if (!made.write(json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n") || !made.move_to(file)) {
    unwritable(file, errno);
  }
}

}  // namespace telemime
