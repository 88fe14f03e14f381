// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

#include "telemime/core/camera.h"
#include "telemime/live/live_session.h"
#include "telemime/live/live_state.h"
#include "telemime/live/recorder.h"
#include "telemime/streaming/sender.h"

namespace telemime {

/// Topics of the web server (web_server.h). For a slow page only the newest message of a topic is queued,
/// except for kWords.
enum PageTopic : int { kWords = 0, kPose = 1, kStatus = 2, kPicture = 3 };

/// The messages of docs/live-protocol.md other than poses, as JSON in one line.

std::string hello_message(const std::string& version, const std::string& input, bool live,
                          const Camera& camera, const std::vector<std::string>& looks,
                          SenderKinds kinds = sender_kinds());

struct LiveStatus {
  LiveState state;
  std::optional<LatencyRecord::Summary> latency;
  double cpu = 0.0;  ///< current processor use, in cores
  std::vector<SenderStatus> outputs;
  std::optional<Recording> recording;
  std::vector<Recording> recordings;
};
std::string status_message(const LiveStatus& status);

std::string words_message(MessageLevel level, const std::string& words);

std::string pong_message(std::int64_t id, double stamp);

/// The binary message of a camera picture, a JPEG at most 480 pixels wide. `stamp`: capture time in ms.
std::string picture_message(const cv::Mat& image, std::int64_t frame, double stamp);

}  // namespace telemime
