// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <initializer_list>
#include <string>
#include <vector>

#include "telemime/core/scratch_folder.h"

namespace telemime::e2e {

/// How a run of the program ended.
struct Ended {
  int code = -1;       ///< exit code; -1 when a signal ended it
  std::string output;  ///< standard output
  std::string words;   ///< standard error
};

/// The program, started and not yet waited for.
class Program {
 public:
  explicit Program(const std::vector<std::string>& arguments);
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  void signal(int number) const;
  bool running();
  Ended wait();
  pid_t process() const { return process_; }
  /// So far: standard output and error.
  std::string output() const;
  std::string words() const;

 private:
  ScratchFolder folder_;  ///< of its standard output and error
  pid_t process_ = -1;
  int status_ = 0;
};

Ended run(const std::vector<std::string>& arguments);

/// The same as a command for a shell, which may do something before or after it.
std::string shell_command(const std::vector<std::string>& arguments);

/// Options for small images and few evaluations, for what does not depend on how exact the poses are.
std::vector<std::string> quickly();

/// Command lines or parts of them, one after the other.
std::vector<std::string> joined(std::initializer_list<std::vector<std::string>> parts);

/// A new empty folder that goes away with its content.
class Folder : public ScratchFolder {
 public:
  std::string operator/(const std::string& name) const { return file(name); }
};

std::string bytes_of(const std::filesystem::path& file);
void write_bytes(const std::filesystem::path& file, const std::string& bytes);

/// A folder of numbered PNG pictures of a person who gestures before a wall, and one of the wall alone; made
/// once.
const std::string& person_clip();
const std::string& wall_clip();
inline constexpr int kPersonFrames = 10;

/// A Motion JPEG video of grey pictures.
void write_grey_video(const std::string& file, int frames, int level);

}  // namespace telemime::e2e
