// SPDX-License-Identifier: Apache-2.0
#include "telemime/capture/image_sequence.h"

#include <fnmatch.h>

#include <algorithm>
#include <cstring>
#include <numeric>
#include <opencv2/imgcodecs.hpp>
#include <optional>
#include <regex>
#include <system_error>
#include <utility>

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

Numbering by_order(std::size_t files) {
  Numbering numbering;
  numbering.places.resize(files);
  std::iota(numbering.places.begin(), numbering.places.end(), 0);
  return numbering;
}

/// `pattern` matches the names of the sequence, with the number as its only group.
Numbering by_number(const std::vector<fs::path>& files, const std::regex& pattern) {
  constexpr std::size_t digits_of_int64 = 18;
  constexpr std::int64_t most_missing = 10;  // per file; other numbers are times or names
  std::vector<std::int64_t> numbers;
  std::int64_t stride = 0;  // a sequence may have every fifth frame
  for (const fs::path& file : files) {
    const std::string name = file.filename().string();
    std::smatch found;
    if (!std::regex_match(name, found, pattern) || found.str(1).size() > digits_of_int64) {
      return by_order(files.size());
    }
    const std::int64_t number = std::stoll(found.str(1));
    if (!numbers.empty() && number <= numbers.back()) {
      return by_order(files.size());
    }
    stride = numbers.empty() ? 0 : std::gcd(stride, number - numbers.back());
    numbers.push_back(number);
  }
  stride = std::max<std::int64_t>(1, stride);
  Numbering numbering;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    numbering.places.push_back((numbers[i] - numbers[0]) / stride);
    const std::int64_t gap = i == 0 ? 0 : numbering.places[i] - numbering.places[i - 1] - 1;
    if (gap > 0) {
      numbering.count += gap;
      numbering.missing += (numbering.missing.empty() ? "" : ", ") + std::to_string(numbers[i - 1] + stride) +
                           (gap > 1 ? " to " + std::to_string(numbers[i] - stride) : "");
    }
  }
  return numbering.count <= most_missing * std::ssize(files) ? numbering : by_order(files.size());
}

/// The pattern of a name by its last number.
std::regex pattern_of(const std::string& name) {
  static const std::regex last_number("^(.*?)([0-9]+)([^0-9]*)$");
  std::smatch found;
  return std::regex(std::regex_match(name, found, last_number)
                        ? escaped(found.str(1)) + "([0-9]+)" + escaped(found.str(3))
                        : "(?!)");
}

class ImageSequence : public Source {
 public:
  ImageSequence(std::vector<fs::path> files, const std::string& input, InputKind kind,
                const InputOptions& options)
      : files_(std::move(files)) {
    numbering_ = numbering_of(files_, input, kind);
    if (numbering_.count > 0) {
      constexpr std::size_t longest = 100;
      std::string which = numbering_.missing;
      if (which.size() > longest) {
        which = which.substr(0, which.rfind(',', longest)) + " ...";
      }
      notes_.add(std::to_string(numbering_.count) + (numbering_.count == 1 ? " number is" : " numbers are") +
                 " missing between the first and the last image (" + which + "); time goes on across them");
    }
    first_ = next_image();
    if (first_.empty()) {
      throw cannot_read(input, kind,
                        files_.size() == 1
                            ? "it is not an image that can be decoded"
                            : "none of its " + std::to_string(files_.size()) + " images can be decoded",
                        "Open one in an image viewer to check that it is complete.");
    }
    require_usable_size(first_.size(), input);
    info_.name = input;
    info_.width = first_.cols;
    info_.height = first_.rows;
    info_.fps = options.rate > 0.0 ? options.rate : images_per_second;
    info_.frames = static_cast<std::int64_t>(files_.size());
  }

  const SourceInfo& info() const override { return info_; }

  std::string complaint() const override {
    Notes all = notes_;
    if (unreadable_ > 0) {
      all.add(std::to_string(unreadable_) + " of " + std::to_string(files_.size()) +
              (unreadable_ == 1 ? " images cannot be decoded and was skipped: "
                                : " images cannot be decoded and were skipped, first ") +
              first_unreadable_);
    }
    return all.text();
  }

  std::optional<Frame> next() override {
    cv::Mat image = first_.empty() ? next_image() : std::exchange(first_, {});
    if (image.empty()) {
      return std::nullopt;
    }
    const std::int64_t index = numbering_.places[upcoming_ - 1];
    if (first_index_ < 0) {
      first_index_ = index;
    }
    return Frame{fit_to(image, {info_.width, info_.height}, notes_), index,
                 static_cast<double>(index - first_index_) / info_.fps};
  }

 private:
  /// The next image that can be decoded; empty after the last one.
  cv::Mat next_image() {
    while (upcoming_ < files_.size()) {
      const fs::path& file = files_[upcoming_++];
      cv::Mat image = decode(file);
      if (!image.empty()) {
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
  Numbering numbering_;
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

Numbering numbering_of(const std::vector<fs::path>& files, const std::string& input, InputKind kind) {
  if (files.empty()) {
    return {};
  }
  const std::optional<std::regex> pattern =
      kind == InputKind::pattern ? number_pattern(fs::path(input).filename().string()) : std::nullopt;
  return by_number(files, pattern ? *pattern : pattern_of(files.front().filename().string()));
}

std::unique_ptr<Source> open_image_sequence(const std::string& input, InputKind kind,
                                            const InputOptions& options) {
  return std::make_unique<ImageSequence>(image_files(input, kind), input, kind, options);
}

}  // namespace telemime
