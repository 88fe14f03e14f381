// SPDX-License-Identifier: Apache-2.0
#include "telemime/live/live_settings.h"

#include <fcntl.h>
#include <sys/file.h>

#include <cerrno>
#include <cstddef>
#include <system_error>

#include "telemime/core/files.h"
#include "telemime/core/json_field.h"

namespace telemime {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr std::size_t kLongestFile = 100'000;  // bytes
constexpr std::size_t kMostOutputs = 64;
constexpr int kVersion = 1;

JsonSource source_of(const fs::path& file) {
  return {
      "the settings in " + file.string(), ErrorKind::config,
      "Correct or delete the file. When an output is added or removed on the page, a new file replaces it, "
      "and this one is renamed to end in \".old\"."};
}

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
  const JsonSource source = source_of(file);
  std::string text;
  try {
    text = read_small_file(file, kLongestFile).content;
  } catch (const std::exception& e) {
    throw Error(source.kind, source.name + ": " + e.what(), source.remedy);
  }
  const Json json = parse_json(text, source);
  const JsonField root(json, source);
  root["version"].integer(kVersion, kVersion);
  const JsonField urls = root["outputs"];
  if (urls.size() > kMostOutputs) {
    urls.fail("must have at most " + std::to_string(kMostOutputs) + " URLs");
  }
  for (std::size_t i = 0; i < urls.size(); ++i) {
    urls[i].text();
  }
  return json;
}

}  // namespace

std::vector<std::string> load_settings(const fs::path& file) {
  return read(file).value("outputs", std::vector<std::string>());
}

void update_settings(const fs::path& file, const std::function<void(std::vector<std::string>&)>& change) {
  std::error_code failed;
  const fs::path target = at_end_of_links(fs::absolute(file, failed));
  make_private_folders(target.parent_path());
  // An exclusive lock on the folder, as long as it is open; no effect on file systems without locks.
  const Descriptor folder(::open(target.parent_path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  while (folder.get() >= 0 && ::flock(folder.get(), LOCK_EX) != 0 && errno == EINTR) {
  }
  bool unusable = false;
  Json json;
  try {
    json = read(target);
  } catch (const Error&) {  // reported when it was loaded; kept as a backup
    unusable = fs::is_regular_file(target, failed);
    json = Json::object();
  }
  auto urls = json.value("outputs", std::vector<std::string>());
  change(urls);
  if (urls.size() > kMostOutputs) {
    urls.erase(urls.begin(), urls.end() - static_cast<std::ptrdiff_t>(kMostOutputs));
  }
  json["version"] = kVersion;
  json["outputs"] = urls;
  const fs::path aside = unusable ? free_name_beside(target) : fs::path();
  if (unusable) {
    fs::rename(target, aside, failed);
  }
  try {
    write_private_file(target, json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n",
                       /*durable=*/true);
  } catch (const Error&) {
    if (unusable) {
      fs::rename(aside, target, failed);
    }
    throw;
  }
}

}  // namespace telemime
