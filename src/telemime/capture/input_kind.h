// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace telemime {

/// What an input named by the user is taken for.
enum class InputKind {
  camera,      ///< an index: "0"
  device,      ///< "/dev/video0"
  stream,      ///< "rtsp://...", "http://...", "udp://...": any scheme but file
  folder,      ///< a folder of images
  pattern,     ///< image files by number (frame_%04d.png) or by wildcard (shots/*.jpg)
  image,       ///< one image file: a sequence of one frame
  video_file,  ///< everything else
};

/// Looks at the name, and at the file system where the name alone does not say. Never throws; a name that
/// nothing else fits is a video file, whether it exists or not.
InputKind input_kind(const std::string& input);

/// "a camera index", "a video file", ...: for messages.
std::string in_words(InputKind kind);

/// The path inside a file:// URL; any other input as it is.
std::string without_file_scheme(const std::string& input);

/// True when the name ends as a kind of image that OpenCV reads (.png, .JPG, ...).
bool has_image_extension(const std::string& name);

}  // namespace telemime
