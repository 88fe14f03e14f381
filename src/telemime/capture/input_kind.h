// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "telemime/core/errors.h"

namespace telemime {

/// Kind of an input that the user named.
enum class InputKind {
  camera,      ///< an index: "0"
  device,      ///< "/dev/video0"
  stream,      ///< "rtsp://...", "http://...", "udp://...": any scheme but file
  folder,      ///< a folder of images
  pattern,     ///< image files by number (frame_%04d.png) or by wildcard (shots/*.jpg)
  image,       ///< one image file: a sequence of one frame
  video_file,  ///< any other name
};

/// Determines the kind from the name and from the file system: what exists there is a file or folder, but for
/// numbers and devices. Never throws; any other name is a video file, whether it exists or not.
InputKind input_kind(const std::string& input);

/// The kind for messages: "a camera index", "a video file", ...
std::string in_words(InputKind kind);

/// The path of a file:// URL; any other input unchanged.
std::string without_file_scheme(const std::string& input);

/// The name by which FFmpeg opens this file: to it "take:2.mp4" alone is a URL.
std::string name_for_ffmpeg(const std::string& path);

/// Whether the name has the extension of an image that OpenCV reads (.png, .JPG, ...).
bool has_image_extension(const std::string& name);

/// The URL of a stream without secrets, for display, files and pages: without "user:password@", and without
/// the query or the path from the first "name=value" on, where many cameras expect their passwords. Other
/// text is returned unchanged.
std::string shown_url(const std::string& url);

/// An Error(input) of the form "cannot read 'x' as a video file: <cause>", for all kinds of input.
Error cannot_read(const std::string& input, InputKind kind, const std::string& cause,
                  const std::string& remedy);

/// Throws Error(input) if the file is missing, not a regular file, not readable by this user, or empty.
void require_readable_file(const std::string& path, InputKind kind);

/// Whether the file begins like plain text (UTF-8 without control characters). FFmpeg would render some text
/// files as videos and follow the links in others.
bool looks_like_text(const std::string& path);

}  // namespace telemime
