// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "telemime/body/motion_frame.h"
#include "telemime/outputs/all.h"
#include "telemime/outputs/file_output.h"

namespace telemime {

/// Files of several formats that get the same motion.
struct MotionFiles {
  struct File {
    std::unique_ptr<FileOutput> output;
    bool own_times = false;  ///< as in OutputFormat
  };
  std::vector<File> all;

  /// Adds the file of a format to `folder`. Throws Error(output).
  void open(const std::filesystem::path& folder, const OutputFormat& format, const OutputOptions& options,
            const StreamHeader& header) {
    all.push_back({std::make_unique<FileOutput>(folder / format.file_name, format.make(options), header),
                   format.own_times});
  }
  /// Writes a frame with the time of its image (`own_times`) to the formats that have such, a resampled one
  /// to the others. Throws Error(output).
  void write(const MotionFrame& frame, bool own_times) const {
    for (const File& file : all) {
      if (file.own_times == own_times) {
        file.output->write(frame);
      }
    }
  }
};

}  // namespace telemime
