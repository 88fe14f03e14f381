// SPDX-License-Identifier: Apache-2.0
#include "cli/progress_bar.h"

#include <unistd.h>

#include <cstdio>
#include <iostream>

namespace telemime {

void ProgressBar::show(const std::string& what, std::int64_t frames, std::int64_t total, double seconds) {
  const auto now = std::chrono::steady_clock::now();
  const bool terminal = isatty(STDERR_FILENO) == 1;
  const double pause = terminal ? 0.1 : 10.0;
  const bool last = total > 0 && frames >= total;
  if (quiet_ || (!last && std::chrono::duration<double>(now - last_).count() < pause) ||
      (last && !terminal)) {
    return;
  }
  last_ = now;
  const double rate = seconds > 0.0 ? static_cast<double>(frames) / seconds : 0.0;
  std::string line = "frame " + std::to_string(frames);
  if (total > 0) {
    constexpr std::int64_t kWidth = 30;
    const auto filled = static_cast<std::size_t>(kWidth * std::min(frames, total) / total);
    line = "[" + std::string(filled, '#') + std::string(kWidth - filled, '.') + "] " +
           std::to_string(frames) + "/" + std::to_string(total);
  }
  line = what.empty() ? line : what + "  " + line;
  char words[64];
  std::snprintf(words, sizeof words, "  %.1f fps", rate);
  line += words;
  if (total > 0 && rate > 0.0) {
    std::snprintf(words, sizeof words, "  %.0f s left", static_cast<double>(total - frames) / rate);
    line += words;
  }
  std::cerr << (terminal ? "\r" : "") << line << (terminal ? "\x1b[K" : "\n") << std::flush;
  open_ = terminal;
}

void ProgressBar::interrupt() {
  if (open_) {
    std::cerr << '\n';
    open_ = false;
  }
}

}  // namespace telemime
