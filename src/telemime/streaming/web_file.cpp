// SPDX-License-Identifier: Apache-2.0
#include "telemime/streaming/web_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <limits>
#include <utility>

namespace telemime {
namespace {

constexpr std::uint64_t kMost = std::numeric_limits<std::uint64_t>::max();

bool is_unit_of_bytes(std::string_view unit) {
  constexpr std::string_view kBytes = "bytes";
  return std::equal(unit.begin(), unit.end(), kBytes.begin(), kBytes.end(),
                    [](char a, char b) { return (a >= 'A' && a <= 'Z' ? a - 'A' + 'a' : a) == b; });
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlanks = " \t";
  const std::size_t first = text.find_first_not_of(kBlanks);
  return first == std::string_view::npos ? std::string_view()
                                         : text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

/// Digits alone; a number that is too big for 64 bits is the biggest.
std::optional<std::uint64_t> number(std::string_view digits) {
  if (digits.empty() || digits.find_first_not_of("0123456789") != std::string_view::npos) {
    return std::nullopt;
  }
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  return error == std::errc() ? value : kMost;
}

}  // namespace

std::optional<WebFile> WebFile::open(const std::filesystem::path& path) {
  // A pipe of that name would be waited for.
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) {
    return std::nullopt;
  }
  struct stat facts {};
  if (::fstat(descriptor, &facts) != 0 || !S_ISREG(facts.st_mode)) {
    ::close(descriptor);
    return std::nullopt;
  }
  const std::string tag = '"' + std::to_string(facts.st_ino) + '-' + std::to_string(facts.st_size) + '-' +
                          std::to_string(facts.st_mtim.tv_sec) + '.' + std::to_string(facts.st_mtim.tv_nsec) +
                          '"';
  return WebFile(descriptor, static_cast<std::uint64_t>(facts.st_size), tag);
}

WebFile::WebFile(int descriptor, std::uint64_t size, std::string tag)
    : descriptor_(descriptor), size_(size), tag_(std::move(tag)) {}

WebFile::WebFile(WebFile&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)), size_(other.size_), tag_(std::move(other.tag_)) {}

WebFile& WebFile::operator=(WebFile&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  std::swap(size_, other.size_);
  std::swap(tag_, other.tag_);
  return *this;
}

WebFile::~WebFile() {
  if (descriptor_ >= 0) {
    ::close(descriptor_);
  }
}

std::size_t WebFile::read(std::uint64_t offset, std::span<char> into) const {
  ssize_t count = -1;
  do {
    count = ::pread(descriptor_, into.data(), into.size(), static_cast<off_t>(offset));
  } while (count < 0 && errno == EINTR);
  return count < 0 ? 0 : static_cast<std::size_t>(count);
}

WebRange web_range(std::string_view header, std::uint64_t size) {
  const WebRange whole{WebRange::Kind::whole, 0, size};
  const WebRange nothing{WebRange::Kind::nothing, 0, 0};
  const std::size_t equals = header.find('=');
  if (equals == std::string_view::npos || !is_unit_of_bytes(trimmed(header.substr(0, equals)))) {
    return whole;
  }
  const std::string_view range = trimmed(header.substr(equals + 1));
  const std::size_t dash = range.find('-');
  if (dash == std::string_view::npos || range.find(',') != std::string_view::npos) {
    return whole;
  }
  const std::optional<std::uint64_t> from = number(range.substr(0, dash));
  const std::optional<std::uint64_t> to = number(range.substr(dash + 1));
  if (dash == 0) {  // the last so many
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
