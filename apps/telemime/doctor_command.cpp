// SPDX-License-Identifier: Apache-2.0
#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <memory>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "cli/data_folder.h"
#include "cli/exit_codes.h"
#include "commands.h"
#include "telemime/capture/cameras.h"
#include "telemime/core/errors.h"
#include "telemime/core/scratch_folder.h"
#include "telemime/offline/track_file.h"

namespace telemime {
namespace {

namespace fs = std::filesystem;

enum class Verdict {
  good,
  note,     ///< works, but less well
  problem,  ///< something will not work
};

struct Finding {
  Verdict verdict = Verdict::good;
  std::string what;
  std::string advice = {};  ///< what to do; may be empty
};

using Findings = std::vector<Finding>;

std::string in_words(const CameraMode& mode) {
  std::ostringstream words;
  words << mode.width << "x" << mode.height << " " << mode.format;
  if (mode.fps > 0.0) {
    words << " at " << std::setprecision(3) << mode.fps << " frames per second";
  }
  return words.str();
}

Finding about(const CameraInfo& camera) {
  const std::string name = camera.device + (camera.name.empty() ? "" : " (" + camera.name + ")");
  if (camera.kind == CameraKind::unknown) {
    const bool forbidden = ::access(camera.device.c_str(), R_OK | W_OK) != 0;
    return {Verdict::problem, name + " cannot be used: " + camera.problem,
            forbidden
                ? "Add yourself to the group that owns it (sudo adduser $USER video), then log in again."
                : "Close other programs that use it, or plug it in again."};
  }
  const auto mode = best_mode(camera.modes);
  if (!mode) {
    return {Verdict::problem, name + " has no format that can be read here"};
  }
  constexpr double kFluent = 20.0;
  const std::string id = camera.by_id.empty() ? "" : "; always the same: " + camera.by_id;
  if (!has_colour(camera)) {
    return {Verdict::note, name + " is an infrared camera: " + in_words(*mode),
            "A camera with colours gives a better pose."};
  }
  if (mode->fps > 0.0 && mode->fps < kFluent) {
    return {Verdict::note, name + " is slow: " + in_words(*mode), "Another USB port may be faster."};
  }
  return {Verdict::good, name + ": " + in_words(*mode) + id};
}

Findings look_at_cameras() {
  const auto cameras = list_cameras();
  Findings findings;
  for (const CameraInfo& camera : cameras) {
    if (camera.kind == CameraKind::camera || camera.kind == CameraKind::unknown) {
      findings.push_back(about(camera));
    } else if (camera.kind == CameraKind::metadata) {
      findings.push_back({Verdict::good, why_no_images(cameras, camera.device)});
    }
  }
  if (!find_camera(cameras, "")) {
    findings.push_back({Verdict::problem, "no camera was found",
                        "Plug one in; a container or a virtual machine must be given one. Without a camera: "
                        "telemime live demo"});
  }
  return findings;
}

std::string processor_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (const std::size_t colon = line.find(": "); line.starts_with("model name") && colon < line.size()) {
      return line.substr(colon + 2);
    }
  }
  return "processor";
}

// How fast the bundled clip is tracked.
Finding look_at_speed() {
  TrackRequest request;
  request.input = (data_folder() / "demo" / "video.mp4").string();
  request.background = (data_folder() / "demo" / "background.mp4").string();
  request.formats = {"jsonl"};
  request.overlay = false;
  request.most_frames = 50;
  request.config.look_back = false;
  request.config.calibration.look_ahead = 0;
  const ScratchFolder folder;
  request.out = folder.path();
  const TrackSummary summary = track_file(request, {});
  const auto& ms = summary.report.at("ms");
  // Two threads share the work: the slower one sets the pace.
  const double frame =
      std::max(ms.at("features").at("median").get<double>(), ms.at("search").at("median").get<double>());
  std::ostringstream words;
  words << processor_name() << ", " << std::thread::hardware_concurrency()
        << " threads: " << std::lround(1000.0 / std::max(1.0, frame))
        << " frames per second at --quality balanced";
  constexpr double kFluent = 45.0, kUsable = 80.0;  // ms
  return frame < kFluent ? Finding{Verdict::good, words.str()}
         : frame < kUsable
             ? Finding{Verdict::note, words.str(), "For quicker motion: --quality fast, or --no-hands."}
             : Finding{Verdict::problem, words.str(), "Use --quality fast, and close other programs."};
}

Findings look_at_processor() {
  return {look_at_speed()};
}

Findings look_at_networks() {
  const Config config;
  if (!uses_networks(config)) {
    return {{Verdict::problem, "the networks are missing: only colours and outlines are used",
             "Install Telemime again, or build it where npm can be reached."}};
  }
  Findings findings = {{Verdict::good, "the networks of pose are installed"}};
  findings.push_back(uses_face(config)
                         ? Finding{Verdict::good, "those of faces, too"}
                         : Finding{Verdict::problem, "those of faces are missing", "Install again."});
  findings.push_back(uses_hands(config)
                         ? Finding{Verdict::good, "those of hands, too"}
                         : Finding{Verdict::problem, "those of hands are missing", "Install again."});
  return findings;
}

bool port_is_free(int port) {
  const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const int yes = 1;
  ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const bool free = ::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  const bool taken = !free && errno == EADDRINUSE;
  ::close(socket);
  return !taken;
}

Findings look_at_page() {
  Findings findings;
  avatar_folder();  // throws when they are missing
  constexpr int kPort = 7070;
  findings.push_back(port_is_free(kPort)
                         ? Finding{Verdict::good, "port 7070 is free for the page"}
                         : Finding{Verdict::note, "port 7070 is in use, maybe by another `telemime live`",
                                   "End that, or give another port: telemime live --port 7071"});
  const bool display = std::getenv("DISPLAY") != nullptr || std::getenv("WAYLAND_DISPLAY") != nullptr;
  findings.push_back(display ? Finding{Verdict::good, "there is a display, for --show and --open"}
                             : Finding{Verdict::note, "no display: --show and --open do not work here",
                                       "Open the page in a browser elsewhere (--address, --allow-host)."});
  return findings;
}

// What a look finds, or why it could not look.
Findings tried(Findings (*look)()) {
  try {
    return look();
  } catch (const Error& e) {
    return {{Verdict::problem, e.what()}};
  } catch (const std::exception& e) {
    return {{Verdict::problem, std::string("unexpected: ") + e.what()}};
  }
}

void run() {
  constexpr std::pair<const char*, Findings (*)()> kLooks[] = {{"Cameras", look_at_cameras},
                                                               {"Networks", look_at_networks},
                                                               {"Page", look_at_page},
                                                               {"Processor", look_at_processor}};
  int problems = 0;
  std::cout << "telemime " << TELEMIME_VERSION << '\n';
  for (const auto& [name, look] : kLooks) {
    std::cout << '\n' << name << std::endl;
    for (const Finding& finding : tried(look)) {
      constexpr const char* kMarks[] = {"  ok       ", "  note     ", "  PROBLEM  "};
      problems += finding.verdict == Verdict::problem ? 1 : 0;
      std::cout << kMarks[static_cast<int>(finding.verdict)] << finding.what << '\n'
                << (finding.advice.empty() ? "" : "           " + finding.advice + "\n");
    }
  }
  std::cout << (problems == 0
                    ? "\nAll is well. Next: telemime live\n"
                    : "\n" + std::to_string(problems) + (problems == 1 ? " problem.\n" : " problems.\n"));
  if (problems > 0) {
    throw ToldAlready(kExitConfig);
  }
}

}  // namespace

void add_doctor_command(CLI::App& app) {
  app.add_subcommand("doctor", "Look at cameras, networks, page and speed, and say what to do")
      ->callback(run);
}

void print_first_steps(std::ostream& out) {
  const auto cameras = list_cameras();
  const auto camera = find_camera(cameras, "");
  const auto known = std::find_if(cameras.begin(), cameras.end(),
                                  [&](const CameraInfo& c) { return camera && c.device == *camera; });
  const std::string name = known == cameras.end() || known->name.empty() ? "" : " (" + known->name + ")";
  out << "Telemime " << TELEMIME_VERSION << ": 3-D motion capture of the upper body from one camera.\n\n"
      << (camera ? "A camera is here: " + *camera + name + "\n\n"
                 : std::string("No camera was found here.\n\n"))
      << (camera ? "  telemime live --open        your avatar moves with you, on a page\n" : "")
      << "  telemime live demo --open   the same with the bundled clip\n"
         "  telemime track CLIP         3-D motion from a video, for Blender and other programs\n"
         "  telemime doctor             what works on this computer, and what to do about the rest\n"
         "  telemime --help             all commands\n";
}

}  // namespace telemime
