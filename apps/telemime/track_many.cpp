// SPDX-License-Identifier: Apache-2.0
#include "track_many.h"

#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <map>
#include <memory>
#include <new>
#include <set>
#include <system_error>
#include <thread>
#include <utility>

#include "cli/exit_codes.h"
#include "cli/interrupt.h"
#include "cli/progress_bar.h"
#include "telemime/capture/input_kind.h"
#include "telemime/core/errors.h"
#include "telemime/offline/finished_run.h"

namespace telemime {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

// What a process tells of its file, in memory that all processes share.
struct Shared {
  std::atomic<std::int64_t> frames{0};
  std::atomic<std::int64_t> total{0};  // 0: not known
};

// One for each file.
class SharedMemory {
 public:
  explicit SharedMemory(std::size_t count) : bytes_(std::max<std::size_t>(1, count) * sizeof(Shared)) {
    void* const memory = ::mmap(nullptr, bytes_, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) {
      throw std::bad_alloc();
    }
    all_ = static_cast<Shared*>(memory);
    std::uninitialized_default_construct_n(all_, count);
  }
  ~SharedMemory() { ::munmap(all_, bytes_); }
  SharedMemory(const SharedMemory&) = delete;
  SharedMemory& operator=(const SharedMemory&) = delete;
  Shared& operator[](std::size_t i) { return all_[i]; }

 private:
  std::size_t bytes_;
  Shared* all_ = nullptr;
};

// The file of one process: its words begin with its name.
int track_one(const TrackRequest& request, const ManyOptions& options, Shared& told) {
  const auto say = [&](const std::string& words) {
    const std::string name = shown_url(request.input) + ": ";
    std::fprintf(stderr, "%s%s\n", words.starts_with(name) ? "" : name.c_str(), words.c_str());
  };
  RunHooks hooks;
  hooks.message = [&](const std::string& words) {
    if (!options.quiet) {
      say(words);
    }
  };
  hooks.progress = [&told](const Progress& progress) {
    told.frames = progress.frames;
    told.total = progress.total;
    return interrupted() ? ViewerRequest::stop : ViewerRequest::none;
  };
  try {
    options.track(request, hooks);
  } catch (const Interrupted&) {
    return kExitInterrupted;
  } catch (const Error& e) {
    say(e.what());
    return exit_code(e.kind());
  } catch (const std::exception& e) {
    say(std::string("unexpected failure: ") + e.what());
    return kExitInternal;
  }
  return 0;
}

pid_t start(const TrackRequest& request, const ManyOptions& options, Shared& told) {
  std::cout.flush();
  const pid_t child = ::fork();
  if (child == 0) {
    // Ctrl-C reaches the first process alone, which passes it on once; nobody outlives it.
    ::setpgid(0, 0);
    ::prctl(PR_SET_PDEATHSIG, SIGTERM);
    const int code = track_one(request, options, told);
    std::fflush(nullptr);
    ::_exit(code);
  }
  if (child < 0) {
    throw Error(ErrorKind::output, "no further process can be started", "Give fewer --jobs.");
  }
  return child;
}

// Exit code of a process that has ended by itself or by a signal.
int code_of(int status) {
  return WIFEXITED(status) ? WEXITSTATUS(status) : kExitInternal;
}

std::string result_of(int status, const TrackRequest& request) {
  if (WIFSIGNALED(status)) {
    return "ended by signal " + std::to_string(WTERMSIG(status));
  }
  const int code = WEXITSTATUS(status);
  return code == 0 ? "results in " + request.out.string() : code == kExitInterrupted ? "stopped" : "failed";
}

// Files that are not begun count as long as the others; those that were done before (`skipped`) do not count.
void show_progress(ProgressBar& bar, SharedMemory& told, std::size_t begun, std::size_t count,
                   std::size_t skipped, Clock::time_point begin) {
  std::int64_t frames = 0, total = 0, known = 0;
  for (std::size_t i = 0; i < begun; ++i) {
    frames += told[i].frames;
    total += told[i].total;
    known += told[i].total > 0 ? 1 : 0;
  }
  const std::int64_t all = known == 0 ? 0 : total * static_cast<std::int64_t>(count - skipped) / known;
  bar.show("file " + std::to_string(begun) + " of " + std::to_string(count), frames, all,
           std::chrono::duration<double>(Clock::now() - begin).count());
}

}  // namespace

std::vector<fs::path> folders_of(const std::vector<std::string>& inputs, const fs::path& out) {
  std::map<std::string, int> stems, names;
  const auto file_of = [](const std::string& input) {
    // Without what a URL holds behind its path: that may be secret. "..": the name of that folder.
    std::error_code failed;
    const fs::path path = fs::absolute(shown_url(without_file_scheme(input)), failed).lexically_normal();
    return path.has_filename() ? path : path.parent_path();  // folder/
  };
  for (const std::string& input : inputs) {
    ++stems[file_of(input).stem().string()];
    ++names[file_of(input).filename().string()];
  }
  std::set<std::string> taken;
  std::vector<fs::path> folders;
  for (const std::string& input : inputs) {
    const fs::path file = file_of(input);
    const std::string stem = file.stem().string();
    const std::string whole = file.filename().string();
    const std::string name = stems[stem] == 1    ? stem
                             : names[whole] == 1 ? whole
                                                 : file.parent_path().filename().string() + "-" + stem;
    std::string free = name;
    for (int number = 2; !taken.insert(free).second; ++number) {
      free = name + "-" + std::to_string(number);
    }
    folders.push_back(out / free);
  }
  return folders;
}

int track_many(const std::vector<TrackRequest>& requests, const ManyOptions& options) {
  note_interrupts();
  std::signal(SIGCHLD, SIG_DFL);  // where it is ignored, no process is seen to end
  SharedMemory told(requests.size());
  std::map<pid_t, std::size_t> running;
  std::size_t next = 0, done = 0, found = 0, failed = 0, stopped = 0, skipped = 0;
  int code = 0;
  bool passed_on = false;
  const auto begin = Clock::now();
  ProgressBar bar(options.quiet);
  const auto say = [&](std::size_t i, const std::string& words) {
    if (!options.quiet) {
      bar.interrupt();
      std::cout << shown_url(requests[i].input) << ": " << words << std::endl;
    }
  };
  while (!running.empty() || (next < requests.size() && !interrupted())) {
    // New processes in the place of those that have ended.
    while (next < requests.size() && running.size() < static_cast<std::size_t>(options.jobs) &&
           !interrupted()) {
      const std::size_t i = next++;
      const FinishedRun before = options.again ? FinishedRun::none : finished_run(requests[i]);
      if (before == FinishedRun::complete) {
        ++found;
        ++skipped;
        say(i, "done before; results in " + requests[i].out.string());
      } else if (before == FinishedRun::nobody_tracked) {
        ++failed;
        ++skipped;
        code = code == 0 ? kExitTracking : code;
        const std::string words = "done before: nobody was tracked; results in " + requests[i].out.string();
        if (options.quiet) {
          std::cerr << shown_url(requests[i].input) << ": " << words << std::endl;
        }
        say(i, words);
      } else {
        running[start(requests[i], options, told[i])] = i;
      }
    }
    // Those that have ended.
    int status = 0;
    for (pid_t child = 0; (child = ::waitpid(-1, &status, WNOHANG)) > 0;) {
      const auto ended = running.find(child);
      if (ended == running.end()) {
        continue;  // not one of ours: this process may have inherited it
      }
      const std::size_t i = ended->second;
      running.erase(ended);
      if (options.quiet && WIFSIGNALED(status)) {
        // A killed process has printed no error itself.
        std::cerr << shown_url(requests[i].input) << ": " << result_of(status, requests[i]) << std::endl;
      }
      say(i, result_of(status, requests[i]));
      ++(code_of(status) == 0 ? done : code_of(status) == kExitInterrupted ? stopped : failed);
      code = code == 0 ? code_of(status) : code;
    }
    if (interrupted() && !std::exchange(passed_on, true)) {
      for (const auto& [child, i] : running) {
        ::kill(child, SIGINT);
      }
    }
    show_progress(bar, told, next, requests.size(), skipped, begin);
    std::this_thread::sleep_for(std::chrono::milliseconds(running.empty() ? 0 : 50));
  }
  bar.interrupt();
  if (!options.quiet) {
    std::cout << done << " tracked, " << found << " done before, " << failed << " failed"
              << (stopped > 0 ? ", " + std::to_string(stopped) + " stopped" : "")
              << (next < requests.size() ? ", " + std::to_string(requests.size() - next) + " not begun" : "")
              << '\n';
  }
  if (interrupted()) {
    throw Interrupted();
  }
  return code;
}

}  // namespace telemime
