// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace telemime {

/// A file that is being sent: it stays open, and what is sent is the file of that moment, also when it is
/// deleted meanwhile.
class WebFile {
 public:
  /// Nothing when it is no plain file, or cannot be read.
  static std::optional<WebFile> open(const std::filesystem::path& path);
  WebFile(WebFile&& other) noexcept;
  WebFile& operator=(WebFile&& other) noexcept;
  WebFile(const WebFile&) = delete;
  WebFile& operator=(const WebFile&) = delete;
  ~WebFile();

  std::uint64_t size() const { return size_; }  ///< bytes
  /// An entity tag with its quotes: another one when the file has changed.
  const std::string& tag() const { return tag_; }
  /// Reads from that byte on; how many bytes it was, 0 at the end or when the disk fails.
  std::size_t read(std::uint64_t offset, std::span<char> into) const;

 private:
  WebFile(int descriptor, std::uint64_t size, std::string tag);

  int descriptor_ = -1;
  std::uint64_t size_ = 0;
  std::string tag_;
};

/// Which part of a file a client asks for.
struct WebRange {
  enum class Kind {
    whole,    ///< all of it
    part,     ///< some bytes: 206
    nothing,  ///< bytes that it does not have: 416
  } kind = Kind::whole;
  std::uint64_t first = 0;
  std::uint64_t size = 0;  ///< bytes; of `whole`, too
};

/// What the header Range asks of `size` bytes (RFC 9110, 14.1.2): one range of bytes. Several ranges, other
/// units and what is malformed mean all of it, as section 14.2 allows.
WebRange web_range(std::string_view header, std::uint64_t size);

}  // namespace telemime
