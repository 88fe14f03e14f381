// SPDX-License-Identifier: Apache-2.0
#include "telemime/outputs/bap/reader.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "telemime/core/errors.h"
#include "telemime/outputs/readers/words.h"

namespace telemime {
namespace {

constexpr std::size_t kOldMaskLength = 169;
constexpr std::size_t kLongestMask = 296;
/// Shorter lines of zeros and ones cannot be told from a frame's values.
constexpr std::size_t kShortestMask = 100;

[[noreturn]] void fail(const std::string& name, std::size_t line, const std::string& what) {
  throw Error(ErrorKind::input, name + ", line " + std::to_string(line) + ": " + what, "is it a BAP file?");
}

bool is_mask(const std::vector<std::string_view>& line) {
  return line.size() >= kShortestMask &&
         std::all_of(line.begin(), line.end(), [](std::string_view w) { return w == "0" || w == "1"; });
}

/// Ids of the bits that are set; 0 for one that has no id today.
std::vector<int> ids_of(const std::vector<std::string_view>& mask) {
  std::vector<int> ids;
  for (std::size_t bit = 0; bit < mask.size(); ++bit) {
    if (mask[bit] == "0") {
      continue;
    }
    const int id = static_cast<int>(bit) + 1;
    if (mask.size() == kOldMaskLength) {
      ids.push_back(bap_id_from_old(id).value_or(0));
    } else {
      ids.push_back(id <= kBapCount ? id : 0);
    }
  }
  return ids;
}

class Parser {
 public:
  explicit Parser(const std::string& name) : name_(name) {}

  void line(const std::vector<std::string_view>& words, std::size_t number) {
    if (is_mask(words)) {
      if (words.size() > kLongestMask) {
        fail(name_, number,
             "the mask has " + std::to_string(words.size()) + " bits; the longest known has 296");
      }
      if (!mask_) {
        mask_ = ids_of(words);
        started_ = true;
        return;
      }
    }
    if (!started_ && words.size() >= 4) {
      header(words, number);
      return;
    }
    values(words, number);
  }

  BapFile finish() {
    if (mask_) {
      file_.complaint = name_ + " ends after the mask of a frame; that frame was left out";
    }
    return std::move(file_);
  }

 private:
  /// version, name (of any number of words), frames a second, number of frames
  void header(const std::vector<std::string_view>& words, std::size_t number) {
    const auto fps = to_number<double>(words[words.size() - 2]);
    const auto count = to_number<std::int64_t>(words.back());
    if (!fps || !std::isfinite(*fps) || !(*fps > 0.0) || !count) {
      fail(name_, number, "the header must end with the frames a second and the number of frames");
    }
    file_.version = words[0];
    for (std::size_t w = 1; w + 2 < words.size(); ++w) {
      file_.name += (w > 1 ? " " : "") + std::string(words[w]);
    }
    file_.fps = *fps;
    file_.stated_frames = *count;
    started_ = true;
  }

  void values(const std::vector<std::string_view>& words, std::size_t number) {
    BapFrame frame;
    const std::vector<int> ids = mask_.value_or(std::vector<int>{});
    frame.number = whole<std::int64_t>(words[0], number);
    const std::size_t count = std::min(ids.size(), words.size() - 1);
    for (std::size_t i = 0; i < count; ++i) {
      const int value = whole<int>(words[i + 1], number);
      if (ids[i] != 0) {
        frame.values.emplace_back(ids[i], value);
      } else {
        ++file_.dropped_values;
      }
    }
    file_.short_frames += count < ids.size() ? 1 : 0;
    file_.dropped_values += words.size() - 1 - count;
    std::sort(frame.values.begin(), frame.values.end());
    file_.frames.push_back(std::move(frame));
    mask_.reset();
    started_ = true;
  }

  template <class Integer>
  Integer whole(std::string_view word, std::size_t number) const {
    const auto value = to_number<Integer>(word);
    if (!value) {
      fail(name_, number, "\"" + std::string(word.substr(0, 40)) + "\" is not a whole number");
    }
    return *value;
  }

  std::string name_;
  BapFile file_;
  std::optional<std::vector<int>> mask_;  ///< ids of the frame whose values come next
  bool started_ = false;
};

}  // namespace

BapFile parse_bap(std::string_view text, const std::string& name) {
  Parser parser(name);
  std::size_t number = 0;
  while (!text.empty()) {
    const std::string_view line = take_line(text);
    ++number;
    const auto words = split_words(line);
    if (!words.empty() && words[0].front() != '#') {
      parser.line(words, number);
    }
  }
  return parser.finish();
}

BapValues values_of(const BapProfile& profile, const BapFrame& frame, const BapValues& last) {
  const auto ids = bap_ids(profile);
  BapValues values = last;
  for (const auto& [id, value] : frame.values) {
    const auto* const found = std::lower_bound(ids.begin(), ids.end(), id);
    if (found != ids.end() && *found == id) {
      values[static_cast<std::size_t>(found - ids.begin())] = value;
    }
  }
  return values;
}

}  // namespace telemime
