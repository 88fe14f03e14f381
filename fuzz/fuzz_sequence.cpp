// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include "fuzz_target.h"
#include "telemime/capture/image_sequence.h"

// The names of a sequence's images, one a line, after the name by which the user gave it.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto read = [](std::string_view text) {
    constexpr std::size_t kLongestName = 255;  // of a file
    std::istringstream lines{std::string(text)};
    std::string input;
    std::getline(lines, input);
    std::vector<std::filesystem::path> files;
    for (std::string name; std::getline(lines, name);) {
      files.emplace_back(name.substr(0, kLongestName));
    }
    std::sort(files.begin(), files.end(),
              [](const auto& a, const auto& b) { return telemime::natural_less(a.string(), b.string()); });
    const std::vector<std::int64_t> places =
        telemime::numbering_of(files, input.substr(0, kLongestName), telemime::input_kind(input)).places;
    const bool rises = std::is_sorted(places.begin(), places.end(), std::less_equal<>());
    if (places.size() != files.size() || !rises || (!places.empty() && places.front() != 0)) {
      std::abort();
    }
    telemime::shown_url(input);
  };
  return telemime::fuzz_one(data, size, read);
}
