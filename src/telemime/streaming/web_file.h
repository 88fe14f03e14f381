// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost/beast/core/file_posix.hpp>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace telemime {

/// A file to send. It stays open, so its content can be sent even if the file is deleted.
struct WebFile {
  boost::beast::file_posix file;
  std::uint64_t size = 0;  ///< bytes
  std::string tag;         ///< an entity tag with its quotes, which changes when the file does
};

/// Returns nothing if this is not a regular file or cannot be read.
std::optional<WebFile> open_web_file(const std::filesystem::path& path);

/// Which part of a file a client asks for.
struct WebRange {
  enum class Kind {
    whole,    ///< all of it
    part,     ///< some bytes: 206
    nothing,  ///< bytes outside of the file: 416
  } kind = Kind::whole;
  std::uint64_t first = 0;
  std::uint64_t size = 0;  ///< bytes; also for `whole`
};

/// The part of `size` bytes that the header Range asks for (RFC 9110, 14.1.2): one range of bytes. Several
/// ranges, other units and malformed headers mean the whole file, as section 14.2 allows.
WebRange web_range(std::string_view header, std::uint64_t size);

}  // namespace telemime
