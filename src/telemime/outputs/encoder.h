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

/// Properties of a stream that are known before its first frame.
struct StreamHeader {
  Body body;
  Camera camera;      ///< of the INPUT image
  double fps = 25.0;  ///< frames per second, > 0
  JointLimits limits;
  bool fingers = false;   ///< skeletons and markers have fingers, where the frames have hands
  nlohmann::json config;  ///< effective configuration, any JSON value
  nlohmann::json extra;   ///< other information (name of the input, version of the program)
};

/// Bytes that replace already written ones at `offset` from the start of the stream.
struct Patch {
  std::size_t offset = 0;
  std::string bytes;
};

/// Encodes motion frames as one file format. Each call returns bytes to append; the bytes returned so far,
/// with the patches applied, are a valid file at any moment. Call begin first, once.
class Encoder {
 public:
  Encoder() = default;
  Encoder(const Encoder&) = delete;
  Encoder& operator=(const Encoder&) = delete;
  virtual ~Encoder() = default;

  /// The head of the file. Throws Error(output) if the format cannot express the header.
  virtual std::string begin(const StreamHeader& header) = 0;
  /// One frame. Non-finite numbers are replaced by the last finite ones, and the frame becomes lost.
  virtual std::string frame(const MotionFrame& frame) = 0;
  /// The tail of the file; empty if the format has none.
  virtual std::string end() { return {}; }
  /// Bytes of the head that changed with the last frame (a frame count); may be empty.
  virtual std::optional<Patch> patch() const { return std::nullopt; }
};

}  // namespace telemime
