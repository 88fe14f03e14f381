// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

#include "telemime/core/camera.h"
#include "telemime/live/live_session.h"
#include "telemime/live/message_level.h"
#include "telemime/live/recorder.h"
#include "telemime/streaming/sender.h"

namespace telemime {

/// Of what the server sends (web_server.h): of all but `words` only the newest waits for a slow page.
/// The camera's pictures are two topics, by turns, in one place: a page may do with half of them.
enum PageTopic : int { kWords = 0, kPose = 1, kStatus = 2, kPicture = 3, kPictureBetween = 4 };

/// The messages of docs/live-protocol.md that are not about a pose, as JSON without line breaks.

std::string hello_message(const std::string& version, const SourceInfo& info, const Camera& camera,
                          const std::vector<std::string>& looks, SenderKinds kinds = sender_kinds());

struct LiveStatus {
  LiveState state;
  std::optional<LatencyRecord::Summary> latency;
  double cpu = 0.0;  ///< cores in use now
  std::vector<SenderStatus> outputs;
  std::optional<Recording> recording;
  std::vector<Recording> recordings;
};
std::string status_message(const LiveStatus& status);

std::string words_message(MessageLevel level, const std::string& words);

std::string pong_message(std::int64_t id, double stamp);

/// The binary message of a picture, at most 480 pixels wide, as a JPEG. `stamp` in ms.
std::string picture_message(const cv::Mat& image, std::int64_t frame, double stamp);

}  // namespace telemime
