// SPDX-License-Identifier: Apache-2.0
#include "run_program.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>

#include "support/synthetic_clip.h"

namespace telemime::e2e {
namespace {

namespace fs = std::filesystem;

struct Clips {
  Folder folder;
  std::string person = folder / "person";
  std::string wall = folder / "wall";
  Clips() {
    const support::SyntheticClip clip = support::synthetic_clip(8, kPersonFrames);
    const auto write = [](const std::string& where, const std::vector<Frame>& frames) {
      fs::create_directory(where);
      for (const Frame& frame : frames) {
        cv::imwrite(where + "/frame_" + std::to_string(1000 + frame.index) + ".png", frame.image);
      }
    };
    write(person, clip.person);
    write(wall, clip.background);
  }
};

const Clips& clips() {
  static const Clips the_clips;
  return the_clips;
}

}  // namespace

Program::Program(const std::vector<std::string>& arguments) {
  std::vector<std::string> words = {TELEMIME_PROGRAM};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  argv.reserve(words.size() + 1);
  for (std::string& word : words) {
    argv.push_back(word.data());
  }
  argv.push_back(nullptr);
  const std::string out = folder_.file("out");
  const std::string err = folder_.file("err");
  process_ = ::fork();
  if (process_ == 0) {
    ::dup2(::open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDOUT_FILENO);
    ::dup2(::open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDERR_FILENO);
    ::execv(argv[0], argv.data());
    ::_exit(127);
  }
}

Program::~Program() {
  if (process_ > 0) {
    ::kill(process_, SIGKILL);
    ::waitpid(process_, &status_, 0);
  }
}

void Program::signal(int number) const {
  ::kill(process_, number);
}

bool Program::running() {
  if (process_ > 0 && ::waitpid(process_, &status_, WNOHANG) == process_) {
    process_ = -1;
  }
  return process_ > 0;
}

Ended Program::wait() {
  if (process_ > 0) {
    ::waitpid(process_, &status_, 0);
    process_ = -1;
  }
  return {WIFEXITED(status_) ? WEXITSTATUS(status_) : -1, bytes_of(folder_.file("out")),
          bytes_of(folder_.file("err"))};
}

std::string Program::output() const {
  return bytes_of(folder_.file("out"));
}

std::string Program::words() const {
  return bytes_of(folder_.file("err"));
}

Ended run(const std::vector<std::string>& arguments) {
  return Program(arguments).wait();
}

std::string shell_command(const std::vector<std::string>& arguments) {
  std::string command = "'" TELEMIME_PROGRAM "'";
  for (const std::string& argument : arguments) {
    command += " '" + argument + "'";
  }
  return command;
}

std::vector<std::string> quickly() {
  std::vector<std::string> options;
  for (const char* setting :
       {"image.width=160", "image.height=120", "filter.mode_least=50", "filter.landmark_evaluations=50",
        "calibration.pose_iterations=200", "calibration.shape_iterations=100", "calibration.rounds=1"}) {
    options.insert(options.end(), {"--set", setting});
  }
  return options;
}

std::vector<std::string> joined(std::initializer_list<std::vector<std::string>> parts) {
  std::vector<std::string> all;
  for (const std::vector<std::string>& part : parts) {
    all.insert(all.end(), part.begin(), part.end());
  }
  return all;
}

std::string bytes_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

void write_bytes(const fs::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
}

const std::string& person_clip() {
  return clips().person;
}

const std::string& wall_clip() {
  return clips().wall;
}

void write_grey_video(const std::string& file, int frames, int level) {
  cv::VideoWriter writer(file, cv::CAP_OPENCV_MJPEG, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 25.0,
                         {160, 120});
  for (int i = 0; i < frames; ++i) {
    writer.write(cv::Mat(120, 160, CV_8UC3, cv::Scalar::all(level)));
  }
}

}  // namespace telemime::e2e
