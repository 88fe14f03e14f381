// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

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

/// Determines the kind from the name and, if that is ambiguous, from the file system. Never throws; any other
/// name is a video file, whether it exists or not.
InputKind input_kind(const std::string& input);

/// The kind for messages: "a camera index", "a video file", ...
std::string in_words(InputKind kind);

/// The path of a file:// URL; any other input unchanged.
std::string without_file_scheme(const std::string& input);

/// Whether the name has the extension of an image that OpenCV reads (.png, .JPG, ...).
bool has_image_extension(const std::string& name);

}  // namespace telemime
