// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "telemime/outputs/bap/profile.h"

namespace telemime {

struct BapFrame {
  std::int64_t number = 0;
  std::vector<std::pair<int, int>> values;  ///< (id, value), ids ascending, in the present numbering
};

/// The content of a BAP file.
struct BapFile {
  std::string version;  ///< empty when the file has no header
  std::string name;
  double fps = 25.0;  ///< 25 when the file does not say
  std::int64_t stated_frames = 0;
  std::vector<BapFrame> frames;
  std::size_t short_frames = 0;  ///< frames with fewer values than mask bits
  std::size_t dropped_values =
      0;                  ///< values without an id: extensions, fingers of the old numbering, surplus
  std::string complaint;  ///< words about a last frame that was cut off; empty when none was
};

/// Reads the text of a BAP file: header, comments (#), then for each frame a line of mask bits and a line of
/// a frame number and values. Tolerates what real files contain: no header, masks of 169 bits (old
/// numbering), 186, 295 or 296 bits, short frames, empty masks, a cut end. Throws Error(input) that names
/// `name` and the line when something that is not a number stands in the place of one, or when a mask is
/// longer than 296.
BapFile parse_bap(std::string_view text, const std::string& name);

/// The values of a profile's parameters in this frame; those that the frame does not have keep their `last`.
BapValues values_of(const BapProfile& profile, const BapFrame& frame, const BapValues& last);

}  // namespace telemime
