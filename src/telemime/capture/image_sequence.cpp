// SPDX-License-Identifier: Apache-2.0
#include "telemime/capture/image_sequence.h"

#include <fnmatch.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <opencv2/imgcodecs.hpp>
#include <optional>
#include <regex>
#include <system_error>
#include <utility>

#include "telemime/capture/input_kind.h"
#include "telemime/capture/picture.h"

namespace telemime {
namespace {

namespace fs = std::filesystem;

constexpr double images_per_second = 25.0;

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// "frame007.png" as "frame7.png".
std::string without_leading_zeros(const std::string& name) {
  std::string result;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const bool in_number = !result.empty() && is_digit(result.back());
    if (name[i] != '0' || in_number || i + 1 == name.size() || !is_digit(name[i + 1])) {
      result += name[i];
    }
  }
  return result;
}

/// The plain files of a folder whose name passes `wanted`, in natural order.
template <typename Wanted>
std::vector<fs::path> files_in(const fs::path& folder, const std::string& input, InputKind kind,
                               Wanted wanted) {
  std::error_code problem;
  std::vector<fs::path> files;
  fs::directory_iterator entry(folder.empty() ? fs::path(".") : folder, problem);
  for (; !problem && entry != fs::directory_iterator(); entry.increment(problem)) {
    std::error_code ignored;
    if (wanted(entry->path().filename().string()) && entry->is_regular_file(ignored)) {
      files.push_back(entry->path());
    }
  }
  if (problem) {
    throw cannot_read(input, kind, "the folder cannot be read: " + problem.message(),
                      "Check its name and its rights.");
  }
  std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
    return natural_less(a.filename().string(), b.filename().string());
  });
  return files;
}

std::string escaped(const std::string& text) {
  static const std::regex special(R"([.^$|()\[\]{}*+?\\])");
  return std::regex_replace(text, special, R"(\$&)");
}

/// "frame_%04d.png" as the expression "frame_([0-9]+)\.png" (printf's padding is a least width, not a width).
std::optional<std::regex> number_pattern(const std::string& name) {
  static const std::regex number("%0?[0-9]*d");
  std::smatch found;
  if (!std::regex_search(name, found, number)) {
    return std::nullopt;
  }
  return std::regex(escaped(found.prefix()) + "([0-9]+)" + escaped(found.suffix()));
}

/// Numbers left out between the first and the last file of a %d pattern.
std::int64_t missing_numbers(const std::vector<fs::path>& files, const std::regex& pattern) {
  constexpr std::size_t digits_of_int64 = 18;
  std::int64_t missing = 0;
  std::int64_t previous = -1;
  for (const fs::path& file : files) {
    const std::string name = file.filename().string();
    std::smatch found;
    if (!std::regex_match(name, found, pattern) || found.str(1).size() > digits_of_int64) {
      continue;
    }
    const std::int64_t number = std::stoll(found.str(1));
    missing += previous >= 0 && number > previous ? number - previous - 1 : 0;
    previous = number;
  }
  return missing;
}

class ImageSequence : public Source {
 public:
  ImageSequence(std::vector<fs::path> files, const std::string& input, InputKind kind)
      : files_(std::move(files)) {
    const std::optional<std::regex> pattern = number_pattern(fs::path(input).filename().string());
    if (const std::int64_t missing = pattern ? missing_numbers(files_, *pattern) : 0; missing > 0) {
      notes_.add(std::to_string(missing) + " numbers are missing between the first and the last image");
    }
    first_ = next_image();
    if (first_.empty()) {
      throw cannot_read(input, kind,
                        files_.size() == 1
                            ? "it is not an image that can be decoded"
                            : "none of its " + std::to_string(files_.size()) + " images can be decoded",
                        "Open one in an image viewer to see whether it is whole.");
    }
    require_usable_size(first_.size(), input);
    info_ = {
        input,         first_.cols, first_.rows, images_per_second, static_cast<std::int64_t>(files_.size()),
        /*live=*/false};
  }

  const SourceInfo& info() const override { return info_; }

  std::string complaint() const override {
    Notes all = notes_;
    if (unreadable_ > 0) {
      all.add(std::to_string(unreadable_) + " of " + std::to_string(files_.size()) +
              " images cannot be decoded and were left out, first " + first_unreadable_);
    }
    return all.text();
  }

  std::optional<Frame> next() override {
    cv::Mat image = first_.empty() ? next_image() : std::exchange(first_, {});
    if (image.empty()) {
      return std::nullopt;
    }
    const auto index = static_cast<std::int64_t>(upcoming_) - 1;
    return Frame{fit_to(image, {info_.width, info_.height}, notes_), index,
                 static_cast<double>(index - first_index_) / images_per_second};
  }

 private:
  /// The next image that can be decoded; empty after the last one.
  cv::Mat next_image() {
    while (upcoming_ < files_.size()) {
      const fs::path& file = files_[upcoming_++];
      cv::Mat image = decode(file);
      if (!image.empty()) {
        if (first_index_ < 0) {
          first_index_ = static_cast<std::int64_t>(upcoming_) - 1;
        }
        return image;
      }
      if (unreadable_++ == 0) {
        first_unreadable_ = file.string();
      }
    }
    return {};
  }

  static cv::Mat decode(const fs::path& file) {
    try {
      return to_bgr8(cv::imread(file.string(), cv::IMREAD_COLOR));  // rotates by EXIF orientation
    } catch (const cv::Exception&) {  // for example a header with an impossible size
      return {};
    }
  }

  std::vector<fs::path> files_;
  SourceInfo info_;
  Notes notes_;
  cv::Mat first_;
  std::size_t upcoming_ = 0;
  std::int64_t first_index_ = -1;
  std::int64_t unreadable_ = 0;
  std::string first_unreadable_;
};

}  // namespace

bool natural_less(const std::string& a, const std::string& b) {
  // strverscmp() takes a number with leading zeros for a fraction.
  const int order = ::strverscmp(without_leading_zeros(a).c_str(), without_leading_zeros(b).c_str());
  return order != 0 ? order < 0 : std::pair(a.size(), a) < std::pair(b.size(), b);
}

std::vector<fs::path> image_files(const std::string& input, InputKind kind) {
  const fs::path path(without_file_scheme(input));
  if (kind == InputKind::image) {
    require_readable_file(path.string(), kind);
    return {path};
  }
  std::vector<fs::path> files;
  if (kind == InputKind::folder) {
    files = files_in(path, input, kind, has_image_extension);
  } else if (const std::optional<std::regex> numbers = number_pattern(path.filename().string())) {
    files = files_in(path.parent_path(), input, kind,
                     [&](const std::string& name) { return std::regex_match(name, *numbers); });
  } else {
    const std::string wildcard = path.filename().string();
    files = files_in(path.parent_path(), input, kind, [&](const std::string& name) {
      return ::fnmatch(wildcard.c_str(), name.c_str(), FNM_PERIOD) == 0;
    });
  }
  if (files.empty()) {
    throw cannot_read(
        input, kind,
        kind == InputKind::folder ? "there is no image in the folder" : "no file fits the pattern",
        "Images end in .png, .jpg, .bmp, .tif, .webp or .ppm. Patterns are like 'frame_%04d.png' or "
        "'shots/*.jpg' (quoted, and with wildcards in the file's name only).");
  }
  return files;
}

std::unique_ptr<Source> open_image_sequence(const std::string& input, InputKind kind) {
  return std::make_unique<ImageSequence>(image_files(input, kind), input, kind);
}

}  // namespace telemime
