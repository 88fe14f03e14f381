// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost/beast/core/file_posix.hpp>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace telemime {

/// A file to send. It stays open: the content is that of this moment, also when the file is deleted.
struct WebFile {
  boost::beast::file_posix file;
  std::uint64_t size = 0;  ///< bytes
  std::string tag;         ///< an entity tag with its quotes, which changes when the file does
};

/// Returns nothing when this is not a plain file or it cannot be read.
std::optional<WebFile> open_web_file(const std::filesystem::path& path);

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
