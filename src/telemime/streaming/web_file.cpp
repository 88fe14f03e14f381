// SPDX-License-Identifier: Apache-2.0
#include "telemime/streaming/web_file.h"

#include <fcntl.h>
#include <sys/stat.h>

#include <algorithm>
#include <boost/algorithm/string/predicate.hpp>
#include <boost/algorithm/string/trim.hpp>
#include <charconv>
#include <limits>

namespace telemime {
namespace {

constexpr std::uint64_t kMost = std::numeric_limits<std::uint64_t>::max();

/// Only digits; a number that does not fit 64 bits becomes the largest.
std::optional<std::uint64_t> number(std::string_view digits) {
  if (digits.empty() || digits.find_first_not_of("0123456789") != std::string_view::npos) {
    return std::nullopt;
  }
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  return error == std::errc() ? value : kMost;
}

}  // namespace

std::optional<WebFile> open_web_file(const std::filesystem::path& path) {
  WebFile opened;
  // Without O_NONBLOCK, opening a pipe would wait for its other end.
  opened.file.native_handle(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  struct stat facts {};
  if (!opened.file.is_open() || ::fstat(opened.file.native_handle(), &facts) != 0 ||
      !S_ISREG(facts.st_mode)) {
    return std::nullopt;
  }
  opened.size = static_cast<std::uint64_t>(facts.st_size);
  opened.tag = '"' + std::to_string(facts.st_ino) + '-' + std::to_string(facts.st_size) + '-' +
               std::to_string(facts.st_mtim.tv_sec) + '.' + std::to_string(facts.st_mtim.tv_nsec) + '"';
  return opened;
}

WebRange web_range(std::string_view header, std::uint64_t size) {
  const WebRange whole{WebRange::Kind::whole, 0, size};
  const WebRange nothing{WebRange::Kind::nothing, 0, 0};
  const std::size_t equals = std::min(header.find('='), header.size());
  const std::string unit = boost::trim_copy(std::string(header.substr(0, equals)));
  const std::string range = boost::trim_copy(std::string(header.substr(std::min(equals + 1, header.size()))));
  const std::size_t dash = range.find('-');
  if (!boost::iequals(unit, "bytes") || dash == std::string::npos || range.find(',') != std::string::npos) {
    return whole;
  }
  const std::optional<std::uint64_t> from = number(range.substr(0, dash));
  const std::optional<std::uint64_t> to = number(range.substr(dash + 1));
  if (dash == 0) {  // the last bytes
    if (!to) {
      return whole;
    }
    const std::uint64_t count = std::min(*to, size);
    return count == 0 ? nothing : WebRange{WebRange::Kind::part, size - count, count};
  }
  const bool open_ended = dash + 1 == range.size();
  if (!from || (!to && !open_ended) || (to && *to < *from)) {
    return whole;
  }
  if (*from >= size) {
    return nothing;
  }
  const std::uint64_t last = std::min(to.value_or(kMost), size - 1);
  return {WebRange::Kind::part, *from, last - *from + 1};
}

}  // namespace telemime
