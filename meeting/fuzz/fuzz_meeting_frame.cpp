// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>

#include "meeting/protocol/pose_detail.h"
#include "meeting/protocol/pose_frame.h"

using namespace telemime::meeting;

namespace {

void read_detail(const std::uint8_t* data, std::size_t size) {
  const auto read = decode_pose_detail({data, size});
  if (!read) {
    return;
  }
  const auto again = decode_pose_detail(encode(*read));
  if (!again || again->sequence != read->sequence || again->fingers != read->fingers ||
      again->face != read->face) {
    std::abort();
  }
}

}  // namespace

// Nothing is ever thrown. A frame or detail that was read can be written, and says the same.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  read_detail(data, size);
  const auto read = decode_pose_frame({data, size});
  if (!read) {
    return 0;
  }
  const auto again = decode_pose_frame(encode(*read));
  if (!again || again->mask != read->mask || again->captured != read->captured ||
      again->confidence != read->confidence) {
    std::abort();
  }
  for (std::size_t bone = 0; bone < telemime::kHumanBoneCount; ++bone) {
    if (!(again->rotation[bone].angularDistance(read->rotation[bone]) < 2e-4)) {
      std::abort();
    }
  }
  return 0;
}
