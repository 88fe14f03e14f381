// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "telemime/body/body.h"
#include "telemime/body/limits.h"
#include "telemime/body/motion_frame.h"
#include "telemime/core/camera.h"

namespace telemime {

/// What is known before the first frame, for the head of a file.
struct StreamHeader {
  Body body;
  Camera camera;      ///< of the INPUT image
  double fps = 25.0;  ///< frames a second, > 0
  JointLimits limits;
  nlohmann::json config;  ///< effective configuration, any JSON value
  nlohmann::json extra;   ///< anything else worth keeping (name of the input, version of the program)
};

/// Bytes that replace as many bytes already written, at `offset` from the start of the stream.
struct Patch {
  std::size_t offset = 0;
  std::string bytes;
};

/// Turns motion frames into the bytes of one file format. Each call returns what is to be appended; what was
/// returned so far, once patched, is a valid file at any moment. Call begin once, first.
class Encoder {
 public:
  Encoder() = default;
  Encoder(const Encoder&) = delete;
  Encoder& operator=(const Encoder&) = delete;
  virtual ~Encoder() = default;

  /// The head of the file. Throws Error(output) when the header cannot be expressed in the format.
  virtual std::string begin(const StreamHeader& header) = 0;
  /// One frame. Numbers that are not finite are replaced by the last finite ones, and the frame is lost.
  virtual std::string frame(const MotionFrame& frame) = 0;
  /// The tail of the file; empty for the formats that need none.
  virtual std::string end() = 0;
  /// Bytes of the head that changed with the last frame (a frame count), or nothing.
  virtual std::optional<Patch> patch() const = 0;
};

}  // namespace telemime
