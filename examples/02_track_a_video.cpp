// SPDX-License-Identifier: Apache-2.0
// Track a video frame by frame and print where the hands are.
// Usage: 02_track_a_video VIDEO BACKGROUND
#include <cstdio>
#include <vector>

#include "telemime/core/errors.h"
#include "telemime/tracker/set_up.h"
#include "telemime/tracker/track_frame.h"

int main(int argc, char** argv) {
  using namespace telemime;
  if (argc != 3) {
    std::puts("usage: 02_track_a_video VIDEO BACKGROUND");
    return 0;
  }
  try {
    const auto video = open_source(argv[1]);
    TrackingRun run = make_tracking_run(Config{}, camera_for(video->info(), "", 60.0));

    std::vector<Frame> empty_room;
    const auto background = open_source(argv[2]);
    while (auto frame = background->next()) {
      empty_room.push_back(*frame);
    }
    run.scene.features.learn_background(empty_room);

    while (const auto frame = video->next()) {
      const FrameEstimate estimate = track_frame(*frame, run).estimate;
      const Eigen::Vector3d hand = estimate.motion.joints[Joint::r_hand] * 1000.0;
      std::printf("%6.2f s  right hand %5.0f %5.0f %5.0f mm  %s\n", frame->time, hand.x(), hand.y(), hand.z(),
                  estimate.note.c_str());
    }
  } catch (const Error& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
  }
  return 0;
}
