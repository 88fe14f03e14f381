// SPDX-License-Identifier: Apache-2.0
#include "telemime/capture/cameras.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <fstream>
#include <map>
#include <string_view>
#include <system_error>
#include <tuple>

#include "telemime/capture/input_kind.h"
#include "telemime/core/errors.h"
#include "telemime/core/text.h"

namespace telemime {
namespace {

namespace fs = std::filesystem;

// Formats that are decoded here, the cheapest first. Those without colours are last.
constexpr std::array<std::string_view, 9> kFormats = {"YUYV", "UYVY", "NV12", "YU12", "YV12",
                                                      "RGB3", "BGR3", "MJPG", "GREY"};

std::size_t rank_of(const std::string& format) {
  return static_cast<std::size_t>(std::find(kFormats.begin(), kFormats.end(), format) - kFormats.begin());
}

// The number of "video12"; nothing for other names.
std::optional<int> number_of(const std::string& name) {
  constexpr std::string_view kStart = "video";
  const bool is_video =
      name.starts_with(kStart) && name.size() > kStart.size() && name.size() < kStart.size() + 6 &&
      std::all_of(name.begin() + kStart.size(), name.end(), [](unsigned char c) { return std::isdigit(c); });
  return is_video ? std::optional(std::stoi(name.substr(kStart.size()))) : std::nullopt;
}

std::string first_line(const fs::path& file) {
  std::string line;
  std::ifstream stream(file);
  std::getline(stream, line);
  return line;
}

bool contains(const std::string& text, const std::string& part) {
  return lower_case(text).find(lower_case(part)) != std::string::npos;
}

// The one camera of a name: of several with the same name, the first.
std::optional<std::string> only_one(const std::vector<CameraInfo>& meant, const std::string& text) {
  if (meant.empty()) {
    return std::nullopt;
  }
  if (std::any_of(meant.begin(), meant.end(),
                  [&](const CameraInfo& c) { return c.name != meant.front().name; })) {
    throw Error(ErrorKind::usage, "'" + text + "' may mean several cameras: " + in_words(meant),
                "Give more of the name, or the device.");
  }
  return meant.front().device;
}

}  // namespace

std::vector<CameraInfo> list_cameras(const fs::path& root, const AskCamera& ask) {
  std::map<int, CameraInfo> cameras;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(root / "dev", ignored)) {
    const std::string name = entry.path().filename().string();
    if (const auto number = number_of(name)) {
      CameraInfo& camera = cameras[*number];
      camera.device = "/dev/" + name;
      camera.name = first_line(root / "sys/class/video4linux" / name / "name");
    }
  }
  for (const auto& entry : fs::directory_iterator(root / "dev/v4l/by-id", ignored)) {
    const auto number = number_of(fs::read_symlink(entry.path(), ignored).filename().string());
    if (number && cameras.contains(*number)) {
      cameras[*number].by_id = "/dev/v4l/by-id/" + entry.path().filename().string();
    }
  }
  std::vector<CameraInfo> list;
  for (auto& [number, camera] : cameras) {
    ask(camera);
    list.push_back(std::move(camera));
  }
  return list;
}

std::optional<CameraMode> best_mode(const std::vector<CameraMode>& modes) {
  constexpr double kEnough = 25.0;  // frames per second
  constexpr double kSlack = 0.1;    // some cameras say 24.99
  constexpr double kArea = 640.0 * 480.0;
  const auto cost = [](const CameraMode& mode) {
    const double missing = std::max(0.0, kEnough - kSlack - (mode.fps > 0.0 ? mode.fps : kEnough));
    const double area = std::abs(std::log(mode.width * static_cast<double>(mode.height) / kArea));
    return std::tuple(rank_of(mode.format) + 1 == kFormats.size(), missing, area, rank_of(mode.format));
  };
  std::optional<CameraMode> best;
  for (const CameraMode& mode : modes) {
    const bool usable = rank_of(mode.format) < kFormats.size() && mode.width > 0 && mode.height > 0;
    if (usable && (!best || cost(mode) < cost(*best))) {
      best = mode;
    }
  }
  return best;
}

bool has_colour(const CameraInfo& camera) {
  return std::any_of(camera.modes.begin(), camera.modes.end(),
                     [](const CameraMode& mode) { return rank_of(mode.format) + 1 < kFormats.size(); });
}

std::optional<std::string> find_camera(const std::vector<CameraInfo>& cameras, const std::string& text) {
  std::vector<CameraInfo> usable;
  std::copy_if(cameras.begin(), cameras.end(), std::back_inserter(usable), [](const CameraInfo& c) {
    return c.kind == CameraKind::camera || c.kind == CameraKind::unknown;
  });
  if (text.empty()) {
    const auto colour = std::find_if(usable.begin(), usable.end(), has_colour);
    return usable.empty() ? std::nullopt
                          : std::optional((colour == usable.end() ? usable.front() : *colour).device);
  }
  for (const CameraInfo& camera : cameras) {
    if (text == camera.device || text == camera.by_id || "/dev/video" + text == camera.device) {
      return camera.device;
    }
  }
  std::vector<CameraInfo> meant;
  std::copy_if(usable.begin(), usable.end(), std::back_inserter(meant), [&](const CameraInfo& c) {
    return contains(c.name, text) || contains(fs::path(c.by_id).filename().string(), text);
  });
  return only_one(meant, text);
}

std::string with_camera_found(const std::string& input,
                              const std::function<std::vector<CameraInfo>()>& list) {
  std::error_code ignored;
  const bool may_be_name = input_kind(input) == InputKind::video_file && !fs::exists(input, ignored);
  return input.empty() || may_be_name ? find_camera(list(), input).value_or(input.empty() ? "0" : input)
                                      : input;
}

std::string why_no_images(const std::vector<CameraInfo>& cameras, const std::string& device) {
  const auto asked = std::find_if(cameras.begin(), cameras.end(), [&](const CameraInfo& c) {
    return c.device == device || c.by_id == device;
  });
  if (asked == cameras.end() || asked->kind == CameraKind::camera || asked->kind == CameraKind::unknown) {
    return "";
  }
  if (asked->kind == CameraKind::no_camera) {
    return device + " (" + asked->name + ") is not a camera";
  }
  const auto images = std::find_if(cameras.begin(), cameras.end(), [&](const CameraInfo& c) {
    return c.kind == CameraKind::camera && c.name == asked->name;
  });
  return device + " is the metadata device of " + asked->name + " and gives no images" +
         (images == cameras.end() ? "" : "; its images come from " + images->device);
}

std::string in_words(const std::vector<CameraInfo>& cameras) {
  std::vector<std::string> words;
  for (const CameraInfo& c : cameras) {
    if (c.kind == CameraKind::camera || c.kind == CameraKind::unknown) {
      words.push_back(c.device + (c.name.empty() ? "" : " (" + c.name + ")"));
    }
  }
  return joined(words);
}

}  // namespace telemime
